#include "twin/diagnose/screen/circumstances.h"

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace twinbench::diagnose::screen {
namespace {

struct Range {
  double lower = INFINITY, upper = -INFINITY;
  int finite = 0;
};

Range RangeOf(const Eigen::VectorXd& values) {
  Range range;
  for (double v : values) {
    if (!std::isfinite(v)) continue;
    range = {std::min(range.lower, v), std::max(range.upper, v), range.finite + 1};
  }
  return range;
}

/// Angle within a turn in steps of 1e-6 rad, so that 0 and a full turn are the same place; 0 if there is none.
long Rounded(const Eigen::VectorXd& angle_rad, int reading) {
  if (angle_rad.size() <= reading || !std::isfinite(angle_rad[reading])) return 0;
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const double within = angle_rad[reading] - kTurn * std::floor(angle_rad[reading] / kTurn);
  return std::lround(within / 1e-6) % std::lround(kTurn / 1e-6);
}

}  // namespace

bool Varies(const Eigen::VectorXd& values) {
  const Range range = RangeOf(values);
  return range.finite > 2 && range.finite >= 0.9 * static_cast<double>(values.size()) &&
         range.upper - range.lower > 1e-12 * (std::abs(range.upper) + std::abs(range.lower));
}

Eigen::VectorXd Normalised(const Eigen::VectorXd& values) {
  const Range range = RangeOf(values);
  const double middle = 0.5 * (range.upper + range.lower), half = 0.5 * (range.upper - range.lower);
  return values.unaryExpr([&](double v) { return std::isfinite(v) && half > 0.0 ? (v - middle) / half : 0.0; });
}

PlaceKey PlaceOfReading(const Schedule& s, int reading) {
  const auto i = static_cast<std::size_t>(reading);
  return {s.setup[i], static_cast<long>(s.phase[i]), s.position[i], Rounded(s.target_rad, reading),
          Rounded(s.reference_rad, reading)};
}

bool SamePass(const Schedule& s, int a, int b) {
  const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
  return s.setup[i] == s.setup[j] && s.pass[i] == s.pass[j] && s.phase[i] == s.phase[j];
}

Eigen::VectorXd TimeInSetup_s(const Schedule& s) {
  std::map<std::pair<int, Phase>, double> start_s;
  Eigen::VectorXd since_s(s.Readings());
  for (int i = 0; i < s.Readings(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    since_s[i] = s.time_s[i] - start_s.try_emplace({s.setup[k], s.phase[k]}, s.time_s[i]).first->second;
  }
  return since_s;
}

std::vector<Spot> SpotsOf(const LinearRun& run) {
  std::vector<Spot> spots;
  for (int x = 0; x < run.Channels(); ++x) {
    const std::string& name = run.channels[static_cast<std::size_t>(x)];
    if (!name.ends_with("_x")) continue;
    const std::string stem = name.substr(0, name.size() - 2);
    for (int y = 0; y < run.Channels(); ++y) {
      if (run.channels[static_cast<std::size_t>(y)] == stem + "_y") spots.push_back({stem, x, y});
    }
  }
  return spots;
}

Eigen::VectorXd Predicted(const LinearRun& run, int channel) {
  const auto rows = Eigen::seqN(channel, run.schedule.Readings(), run.Channels());
  return run.observed(rows) - run.residual(rows);
}

}  // namespace twinbench::diagnose::screen
