#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/words.h"

namespace twinbench::diagnose::screen {
namespace {

/// Squares of each reading's least-squares amplitude of the pattern in levelled channels, summed.
Eigen::RowVectorXd PatternPower(const Sample& s, const Eigen::VectorXd& weight) {
  const int channels = s.run.Channels();
  Eigen::RowVectorXd power(s.Columns());
  for (int j = 0; j < s.Columns(); ++j) {
    const Eigen::Map<const Eigen::MatrixXd> readings(s.levelled.col(j).data(), channels, s.run.schedule.Readings());
    power[j] = (weight.transpose() * readings).squaredNorm() / weight.squaredNorm();
  }
  return power;
}

/// The pattern in units of the noise of each channel.
Eigen::VectorXd WhiteWeight(const LinearRun& run, const Pattern& pattern) {
  Eigen::VectorXd weight = pattern.weight;
  for (int c = 0; c < run.Channels(); ++c) weight[c] /= TypicalSigma(run, c);
  return weight;
}

}  // namespace

Tests TestPatterns(const Sample& s) {
  if (s.run.Channels() < 2 || s.run.patterns.empty()) return {};
  Eigen::MatrixXd values(std::ssize(s.run.patterns), s.Columns());
  std::vector<std::string> names;
  std::vector<Eigen::VectorXd> weights;
  for (const Pattern& pattern : s.run.patterns) {
    weights.push_back(WhiteWeight(s.run, pattern));
    values.row(std::ssize(names)) = PatternPower(s, weights.back());
    names.push_back(pattern.name);
  }
  auto found = TestMoments(values, names, "channel pattern", Sides::kUpper);
  if (!found) return {};
  const auto item = static_cast<std::size_t>(found->item);
  const double variance = std::max(0.0, found->excess) / s.run.schedule.Readings() / weights[item].squaredNorm();
  const double amplitude = s.level.mean() * std::sqrt(variance);
  Eigen::Index channel = 0;
  const double shown = s.run.patterns[item].weight.cwiseAbs().maxCoeff(&channel);
  SetEffect(s.run, static_cast<int>(channel), amplitude * shown, found->test);
  if (IsAngle(names[item])) found->test.effect_rad = amplitude;
  found->test.reading = fmt::format(
      "channels move together as in {} more than noise does: a body moves that way, or "
      "its model is wrong",
      names[item]);
  return {std::move(found->test)};
}

}  // namespace twinbench::diagnose::screen
