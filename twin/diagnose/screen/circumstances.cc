#include "twin/diagnose/screen/circumstances.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "twin/core/units.h"

namespace twinbench::diagnose::screen {
namespace {

constexpr double kTurn = units::turn;

struct Range {
  double lower = INFINITY, upper = -INFINITY;
  int finite = 0;
};

Range RangeOf(const Eigen::VectorXd& values) {
  Range range;
  for (double v : values) {
    if (std::isfinite(v)) range = {std::min(range.lower, v), std::max(range.upper, v), range.finite + 1};
  }
  return range;
}

double WithinTurn(double angle_rad) {
  return angle_rad - kTurn * std::floor(angle_rad / kTurn);
}

/// Angle within a turn in steps of 1e-6 rad, so that 0 and a full turn are the same place; 0 if there is none.
long Rounded(const Eigen::VectorXd& angle_rad, int reading) {
  if (angle_rad.size() <= reading || !std::isfinite(angle_rad[reading])) return 0;
  return std::lround(WithinTurn(angle_rad[reading]) / 1e-6) % std::lround(kTurn / 1e-6);
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

Eigen::MatrixXd Recorded(const Eigen::MatrixXd& values) {
  return values.unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; });
}

PlaceKey PlaceOfReading(const Schedule& s, int i) {
  return {s.setup[i], static_cast<long>(s.phase[i]), s.position[i], Rounded(s.target_rad, i),
          Rounded(s.reference_rad, i)};
}

bool SamePass(const Schedule& s, int a, int b) {
  return s.setup[a] == s.setup[b] && s.pass[a] == s.pass[b] && s.phase[a] == s.phase[b];
}

Eigen::VectorXd TimeInSetup_s(const Schedule& s) {
  std::map<std::pair<int, Phase>, double> start_s;
  Eigen::VectorXd since_s(s.Readings());
  for (int i = 0; i < s.Readings(); ++i)
    since_s[i] = s.time_s[i] - start_s.try_emplace({s.setup[i], s.phase[i]}, s.time_s[i]).first->second;
  return since_s;
}

std::vector<AngleArgument> AnglesOf(const LinearRun& run) {
  const Eigen::VectorXd &target = run.schedule.target_rad, &reference = run.schedule.reference_rad;
  std::vector<AngleArgument> all = {{"target angle", target, true}, {"reference angle", reference, true}};
  if (target.size() == reference.size()) {
    all.push_back({"sum of both angles", target + reference});
    all.push_back({"difference of both angles", target - reference});
  }
  std::erase_if(all, [](const AngleArgument& a) { return !Varies(a.angle_rad); });
  return all;
}

int HighestOrder(const Eigen::VectorXd& angle_rad) {
  constexpr int kMost = 16;
  std::set<long> different;
  for (double a : angle_rad) different.insert(std::lround((a / kTurn - std::floor(a / kTurn)) * 1e4) % 10000);
  return std::min(kMost, (static_cast<int>(different.size()) - 1) / 2);
}

Eigen::MatrixXd Wave(const Eigen::VectorXd& phase_rad) {
  Eigen::MatrixXd wave(phase_rad.size(), 2);
  wave << phase_rad.array().cos(), phase_rad.array().sin();
  return Recorded(wave);
}

std::vector<Spot> SpotsOf(const LinearRun& run) {
  std::vector<Spot> spots;
  for (int x = 0; x < run.Channels(); ++x) {
    if (!run.channels[x].ends_with("_x")) continue;
    const std::string stem = run.channels[x].substr(0, run.channels[x].size() - 2);
    const auto y = std::ranges::find(run.channels, stem + "_y");
    if (y != run.channels.end()) spots.push_back({stem, x, static_cast<int>(y - run.channels.begin())});
  }
  return spots;
}

Eigen::VectorXd Predicted(const LinearRun& run, int channel) {
  const auto rows = Eigen::seqN(channel, run.schedule.Readings(), run.Channels());
  return run.observed(rows) - run.residual(rows);
}

}  // namespace twinbench::diagnose::screen
