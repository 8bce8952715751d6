#include <algorithm>
#include <cmath>
#include <numeric>

#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/scan.h"
#include "twin/diagnose/screen/tests.h"

/// What channels or detectors show more than others, and what they show together.
namespace twinbench::diagnose::screen {
namespace {

/// Log of the mean square by degree of freedom: channels x columns, each column less its mean over the channels.
Eigen::MatrixXd RelativeLevels(const Sample& s) {
  Eigen::MatrixXd level(s.run.Channels(), s.Columns());
  for (int c = 0; c < s.run.Channels(); ++c) {
    const auto rows = RowsOf(s.run, c);
    level.row(c) = s.residual(rows, Eigen::all).colwise().squaredNorm() / s.redundancy(rows).sum();
  }
  level = level.array().max(1e-300).log().matrix();
  return level.rowwise() - level.colwise().mean();
}

/// @param channel  Of each item.
void TestLevels(const Sample& s, const Statistic& levels, const std::vector<int>& channel, Tests& tests) {
  const auto meaning = [&](int item, double excess, ScreenTest& test) {
    const double ratio = std::exp(0.5 * excess);
    SetEffect(s.run, channel[item], Excess(TypicalSigma(s.run, channel[item]), ratio), test);
    test.reading = ReadingOf(test.name, levels.items[item], ratio);
  };
  TestMoments(levels, Sides::kBoth, meaning, tests);
}

/// Adds the spot's score in the model variance = 1 + k radius, radius on [-1, 1]: sum of (r^2 - 1 + leverage)
/// radius.
/// @return the score's slope
double AddRadiusScore(const Sample& s, const Spot& spot, Statistic& scores) {
  const Eigen::VectorXd x = Predicted(s.run, spot.x), y = Predicted(s.run, spot.y);
  Eigen::VectorXd radius = Normalised((x.array().square() + y.array().square()).sqrt());
  radius.array() -= radius.mean();
  double information = 0.0;
  for (int c : {spot.x, spot.y}) {
    const Eigen::VectorXd redundancy = s.redundancy(RowsOf(s.run, c));
    const Eigen::MatrixXd squares = s.levelled(RowsOf(s.run, c), Eigen::all).cwiseAbs2();
    scores.values.row(std::ssize(scores.items)) += radius.transpose() * (squares.colwise() - redundancy);
    information += radius.cwiseAbs2().dot(redundancy);
  }
  scores.items.push_back(spot.name);
  return information;
}

void TestRadius(const Sample& s, const std::vector<Spot>& spots, Tests& tests) {
  if (spots.empty()) return;
  Statistic scores{"noise against spot radius", {}, Eigen::MatrixXd::Zero(std::ssize(spots), s.Columns())};
  std::vector<double> information;
  for (const Spot& spot : spots) information.push_back(AddRadiusScore(s, spot, scores));
  const auto meaning = [&](int item, double excess, ScreenTest& test) {
    const double slope = excess / information[item];
    SetEffect(s.run, spots[item].x, TypicalSigma(s.run, spots[item].x) * std::sqrt(std::abs(2.0 * slope)), test);
    test.reading = ReadingOf(test.name, spots[item].name, slope > 0.0 ? "grows" : "falls");
  };
  TestMoments(scores, Sides::kBoth, meaning, tests);
}

/// The pattern in units of the noise of each channel.
Eigen::VectorXd WhiteWeight(const LinearRun& run, const Pattern& pattern) {
  Eigen::VectorXd weight = pattern.weight;
  for (int c = 0; c < run.Channels(); ++c) weight[c] /= TypicalSigma(run, c);
  return weight;
}

/// Squares of each reading's least-squares amplitude of the pattern in levelled channels, summed.
Eigen::RowVectorXd PatternPower(const Sample& s, const Eigen::VectorXd& weight) {
  Eigen::MatrixXd amplitude = Eigen::MatrixXd::Zero(s.run.schedule.Readings(), s.Columns());
  for (int c = 0; c < s.run.Channels(); ++c) amplitude += weight[c] * s.levelled(RowsOf(s.run, c), Eigen::all);
  return amplitude.colwise().squaredNorm() / weight.squaredNorm();
}

}  // namespace

void TestNoiseScale(const Sample& s, Tests& tests) {
  if (s.run.Channels() < 2) return;
  const Eigen::MatrixXd level = RelativeLevels(s);
  const std::vector<Spot> spots = SpotsOf(s.run);
  std::vector<int> all(s.run.channels.size()), first_of_spot;
  std::iota(all.begin(), all.end(), 0);
  TestLevels(s, {"noise of the channels", s.run.channels, level}, all, tests);
  Statistic of_spots{"noise of the detectors", {}, Eigen::MatrixXd(std::ssize(spots), s.Columns())};
  for (const auto& [name, x, y] : spots) {
    of_spots.values.row(std::ssize(first_of_spot)) = 0.5 * (level.row(x) + level.row(y));
    of_spots.items.push_back(name);
    first_of_spot.push_back(x);
  }
  if (spots.size() > 1) TestLevels(s, of_spots, first_of_spot, tests);
  TestRadius(s, spots, tests);
}

void TestPatterns(const Sample& s, Tests& tests) {
  const std::vector<Pattern>& patterns = s.run.patterns;
  if (s.run.Channels() < 2 || patterns.empty()) return;
  Statistic power{"channel pattern", {}, Eigen::MatrixXd(std::ssize(patterns), s.Columns())};
  for (const Pattern& pattern : patterns) {
    power.values.row(std::ssize(power.items)) = PatternPower(s, WhiteWeight(s.run, pattern));
    power.items.push_back(pattern.name);
  }
  const auto meaning = [&](int item, double excess, ScreenTest& test) {
    const double variance = std::max(0.0, excess) / s.run.schedule.Readings();
    const double shown = WhiteWeight(s.run, patterns[item]).norm();
    SetEffect(s.run, patterns[item], s.level.mean() * std::sqrt(variance) / shown, test);
    test.reading = ReadingOf(test.name, patterns[item].name);
  };
  TestMoments(power, Sides::kUpper, meaning, tests);
}

/// A converter that is switched from channel to channel may keep a trace of the one before. Channels are scanned in
/// the order of the run, again and again, so that the last comes before the first.
void TestChannelOrder(const Sample& s, Tests& tests) {
  const int channels = s.run.Channels();
  const Eigen::MatrixXd none = Eigen::VectorXd::Zero(s.run.schedule.Readings());
  Scan scan{"channel order"};
  for (int c = 0; c < channels && channels > 1; ++c) {
    const int before = (c + channels - 1) % channels;
    std::vector<Eigen::MatrixXd> shape(channels, none);
    shape[c] = Normalised(Predicted(s.run, before));
    scan.Add(std::move(shape), s.run.channels[before], s.run.channels[c]);
  }
  TestScan(s, scan, tests);
}

}  // namespace twinbench::diagnose::screen
