#include <fmt/format.h>

#include <cmath>

#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/words.h"

namespace twinbench::diagnose::screen {
namespace {

/// Log of the mean square by degree of freedom: channels x columns, each column less its mean over the channels.
Eigen::MatrixXd RelativeLevels(const Sample& s) {
  const int channels = s.run.Channels(), readings = s.run.schedule.Readings();
  Eigen::MatrixXd level(channels, s.Columns());
  for (int c = 0; c < channels; ++c) {
    const auto rows = Eigen::seqN(c, readings, channels);
    level.row(c) = s.residual(rows, Eigen::all).colwise().squaredNorm() / s.redundancy(rows).sum();
  }
  level = level.array().max(1e-300).log().matrix();
  return level.rowwise() - level.colwise().mean();
}

void TestChannels(const Sample& s, const Eigen::MatrixXd& level, Tests& tests) {
  auto found = TestMoments(level, s.run.channels, "noise of the channels", Sides::kBoth);
  if (!found) return;
  const double ratio = std::exp(0.5 * found->excess);
  SetEffect(s.run, found->item, TypicalSigma(s.run, found->item) * std::sqrt(std::abs(ratio * ratio - 1.0)),
            found->test);
  found->test.reading = fmt::format(
      "residual of {} is {:.3f} times that of the channels together: noisy channel, or a cause that "
      "shows there only",
      s.run.channels[static_cast<std::size_t>(found->item)], ratio);
  tests.push_back(std::move(found->test));
}

void TestSpots(const Sample& s, const Eigen::MatrixXd& level, const std::vector<Spot>& spots, Tests& tests) {
  if (spots.size() < 2) return;
  Eigen::MatrixXd values(static_cast<Eigen::Index>(spots.size()), s.Columns());
  std::vector<std::string> names;
  for (const Spot& spot : spots) {
    values.row(static_cast<Eigen::Index>(names.size())) = 0.5 * (level.row(spot.x) + level.row(spot.y));
    names.push_back(spot.name);
  }
  auto found = TestMoments(values, names, "noise of the detectors", Sides::kBoth);
  if (!found) return;
  const double ratio = std::exp(0.5 * found->excess);
  const int channel = spots[static_cast<std::size_t>(found->item)].x;
  SetEffect(s.run, channel, TypicalSigma(s.run, channel) * std::sqrt(std::abs(ratio * ratio - 1.0)), found->test);
  found->test.reading = fmt::format(
      "residual of {} is {:.3f} times that of the detectors together: its electronics, "
      "its distance, or light that reaches it alone",
      names[static_cast<std::size_t>(found->item)], ratio);
  tests.push_back(std::move(found->test));
}

/// Score of the model variance = 1 + k radius, radius on [-1, 1]: sum of (r^2 - 1 + leverage) radius. Also its
/// slope.
struct RadiusScore {
  Eigen::RowVectorXd value;
  double information = 0.0;
};

RadiusScore ScoreOfRadius(const Sample& s, const Spot& spot) {
  const Eigen::VectorXd x = Predicted(s.run, spot.x), y = Predicted(s.run, spot.y);
  Eigen::VectorXd radius = Normalised((x.array().square() + y.array().square()).sqrt().matrix());
  radius.array() -= radius.mean();
  RadiusScore score{Eigen::RowVectorXd::Zero(s.Columns()), 0.0};
  for (int i = 0; i < s.run.schedule.Readings(); ++i) {
    for (int c : {spot.x, spot.y}) {
      const int row = i * s.run.Channels() + c;
      score.value += radius[i] * (s.levelled.row(row).array().square() - s.redundancy[row]).matrix();
      score.information += radius[i] * radius[i] * s.redundancy[row];
    }
  }
  return score;
}

void TestRadius(const Sample& s, const std::vector<Spot>& spots, Tests& tests) {
  Eigen::MatrixXd values(static_cast<Eigen::Index>(spots.size()), s.Columns());
  std::vector<double> information;
  std::vector<std::string> names;
  for (const Spot& spot : spots) {
    const RadiusScore score = ScoreOfRadius(s, spot);
    values.row(static_cast<Eigen::Index>(names.size())) = score.value;
    information.push_back(score.information);
    names.push_back(spot.name);
  }
  if (spots.empty()) return;
  auto found = TestMoments(values, names, "noise against spot radius", Sides::kBoth);
  if (!found) return;
  const auto item = static_cast<std::size_t>(found->item);
  const double slope = found->excess / information[item];
  SetEffect(s.run, spots[item].x, TypicalSigma(s.run, spots[item].x) * std::sqrt(std::abs(2.0 * slope)),
            found->test);
  found->test.reading = fmt::format(
      "scatter on {} {} with the distance of the spot from the centre: speckle, spot shape, stray light, "
      "or a detector that is not linear",
      names[item], slope > 0.0 ? "grows" : "falls");
  tests.push_back(std::move(found->test));
}

}  // namespace

Tests TestNoiseScale(const Sample& sample) {
  Tests tests;
  if (sample.run.Channels() < 2) return tests;
  const Eigen::MatrixXd level = RelativeLevels(sample);
  const std::vector<Spot> spots = SpotsOf(sample.run);
  TestChannels(sample, level, tests);
  TestSpots(sample, level, spots, tests);
  TestRadius(sample, spots, tests);
  return tests;
}

}  // namespace twinbench::diagnose::screen
