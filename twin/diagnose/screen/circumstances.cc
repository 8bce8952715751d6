#include "twin/diagnose/screen/circumstances.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "twin/core/units.h"

namespace twinbench::diagnose::screen {
namespace {

double WithinTurn(double angle_rad) {
  return angle_rad - units::turn * std::floor(angle_rad / units::turn);
}

/// Angle within a turn in steps of 1e-6 rad, so that 0 and a full turn are the same place; 0 if there is none.
long Rounded(const Eigen::VectorXd& angle_rad, int reading) {
  if (angle_rad.size() <= reading || !std::isfinite(angle_rad[reading])) return 0;
  return std::lround(WithinTurn(angle_rad[reading]) / 1e-6) % std::lround(units::turn / 1e-6);
}

double Least(const Eigen::VectorXd& values) {
  return values.minCoeff<Eigen::PropagateNumbers>();
}

/// True for the patterns that are rotations.
bool IsAngle(const std::string& pattern) {
  return pattern == "yaw" || pattern == "tilt" || pattern == "roll";
}

bool ReadsAngles(const LinearRun& run) {
  return run.unit == "arcsec" || run.unit == "deg" || run.unit == "rad";
}

}  // namespace

bool Varies(const Eigen::VectorXd& values) {
  const auto recorded = static_cast<double>(values.array().isFinite().count());
  if (recorded <= 2.0 || recorded < 0.9 * static_cast<double>(values.size())) return false;
  const double lower = Least(values), upper = -Least(-values);
  return upper - lower > 1e-12 * (std::abs(upper) + std::abs(lower));
}

Eigen::VectorXd Normalised(const Eigen::VectorXd& values) {
  const double lower = Least(values), upper = -Least(-values), half = 0.5 * (upper - lower);
  if (!(half > 0.0)) return Eigen::VectorXd::Zero(values.size());
  return Recorded((values.array() - 0.5 * (upper + lower)) / half);
}

Eigen::MatrixXd Recorded(const Eigen::MatrixXd& values) {
  return values.unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; });
}

Eigen::MatrixXd Wave(const Eigen::VectorXd& phase_rad) {
  Eigen::MatrixXd wave(phase_rad.size(), 2);
  wave << phase_rad.array().cos(), phase_rad.array().sin();
  return Recorded(wave);
}

Eigen::MatrixXd SumsByGroup(const Eigen::MatrixXd& rows, const std::vector<int>& group) {
  const int groups = group.empty() ? 0 : *std::ranges::max_element(group) + 1;
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(groups, rows.cols());
  for (std::size_t i = 0; i < group.size(); ++i) {
    if (group[i] >= 0) sums.row(group[i]) += rows.row(i);
  }
  return sums;
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
  std::set<long> different;
  for (double turns : Eigen::VectorXd(angle_rad / units::turn))
    different.insert(std::lround((turns - std::floor(turns)) * 1e4) % 10000);
  return std::min(16, (static_cast<int>(different.size()) - 1) / 2);
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
  return run.Predicted()(RowsOf(run, channel));
}

std::string Amount(const LinearRun& run, int channel, double value_SI) {
  const ChannelUnit unit = run.UnitOf(channel);
  return fmt::format("{:.3g} {}", value_SI / unit.to_SI, unit.name);
}

double AsAngle(const LinearRun& run, int channel, double size_SI) {
  if (ReadsAngles(run)) return size_SI;
  double shown = 0.0;
  for (const Pattern& p : run.patterns) {
    if (IsAngle(p.name)) shown = std::max(shown, std::abs(p.weight[channel]));
  }
  return shown > 0.0 ? size_SI / shown : kNaN;
}

void SetEffect(const LinearRun& run, int channel, double size_SI, ScreenTest& test) {
  if (run.IsMixed()) return;  // neither a length nor an angle
  test.effect_m = ReadsAngles(run) ? kNaN : size_SI;
  test.effect_rad = AsAngle(run, channel, size_SI);
}

void SetEffect(const LinearRun& run, const Pattern& pattern, double amplitude, ScreenTest& test) {
  int channel = 0;
  const double shown = pattern.weight.cwiseAbs().maxCoeff(&channel);
  SetEffect(run, channel, shown * amplitude, test);
  if (IsAngle(pattern.name)) test.effect_rad = amplitude;
}

int AnyChannel(const LinearRun& run) {
  int most = 0;
  for (int c = 1; c < run.Channels(); ++c) {
    if (AsAngle(run, c, 1.0) > AsAngle(run, most, 1.0)) most = c;
  }
  return most;
}

double TypicalSigma(const LinearRun& run, int channel) {
  return run.sigma(RowsOf(run, channel)).norm() / std::sqrt(static_cast<double>(run.schedule.Readings()));
}

double Excess(double sigma, double ratio) {
  return sigma * std::sqrt(std::abs(ratio * ratio - 1.0));
}

}  // namespace twinbench::diagnose::screen
