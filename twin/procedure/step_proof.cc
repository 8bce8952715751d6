#include "twin/procedure/step_proof.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "twin/core/device_fault.h"
#include "twin/procedure/machine_watch.h"
#include "twin/procedure/watch.h"
#include "twin/procedure/whereabouts.h"

namespace twinbench::procedure {
namespace {

constexpr double kShareOfStep = 0.25;
constexpr double kTimesOfNoise = 10.0 * std::numbers::sqrt2;  // of the difference of two
constexpr double kAnotherGain = 3.0;
constexpr double kFar = 10.0;  // times what noise may do to a step

void GoStraight(MachineBench& bench, const std::vector<double>& to, const MachineOptions& options) {
  constexpr double kSlow = 1e-3;  // m/s or rad/s
  const std::vector<AxisState> from = bench.machine.State();
  RequireMayGo(bench.machine.Axes(), from, to, options);
  double takes_s = 0.0;
  for (std::size_t k = 0; k < to.size(); ++k) takes_s += std::abs(to[k] - from[k].encoder) / kSlow;
  Whereabouts where(bench.machine.Axes(), options.axes);
  bench.machine.StartMove(to, 0.0);
  where.SentTo(to);
  Watch(bench, takes_s, where, options);
}

std::vector<double> CommandedOf(MachineBench& bench) {
  std::vector<double> at;
  for (const AxisState& axis : bench.machine.State())
    at.push_back(std::isnan(axis.commanded) ? axis.encoder : axis.commanded);
  return at;
}

/// What the column should do that does most, with its sign; 0: none is of a size.
double LargestStep(const std::vector<ColumnInStep>& columns) {
  double largest = 0.0;
  for (const ColumnInStep& column : columns)
    if (column.is_of_size && std::abs(column.should) > std::abs(largest)) largest = column.should;
  return largest;
}

double NoiseOf(const ColumnInStep& column) {
  return kTimesOfNoise * column.noise;
}

/// Of those without a size one or the other goes, unless the axes stand, where one should go far.
bool NothingGoes(const std::vector<ColumnInStep>& columns) {
  bool should_go = false;
  for (const ColumnInStep& column : columns) {
    if (column.is_of_size) continue;
    if (std::abs(column.did) > NoiseOf(column)) return false;
    should_go = should_go || std::abs(column.should) > kFar * NoiseOf(column);
  }
  return should_go;
}

}  // namespace

void StepProof::Learn(const std::vector<ColumnInStep>& columns, double step) {
  const double size = std::abs(step);
  for (const ColumnInStep& column : columns) {
    const bool goes =
        std::abs(column.did) * kAnotherGain > std::abs(column.should) && std::abs(column.did) < kAnotherGain * size;
    if (column.should != 0.0 ? !goes : std::abs(column.did) * kAnotherGain > size) return;
  }
  for (const ColumnInStep& column : columns) known_.push_back(column.did / step);
}

void StepProof::Require(std::vector<ColumnInStep> columns) {
  const double step = LargestStep(columns);
  if (learns_ && known_.empty()) Learn(columns, step);
  for (std::size_t k = 0; k < known_.size(); ++k) columns[k].should = known_[k] * step;
  const double size = std::abs(LargestStep(columns));
  const bool nothing_goes = NothingGoes(columns);
  for (const ColumnInStep& column : columns) {
    const double noise = NoiseOf(column);
    const bool is_elsewhere =
        !(std::abs(column.did - column.should) <= kShareOfStep * size + noise);  // or shows nothing
    const bool is_against =
        column.did * column.should < 0.0 && std::min(std::abs(column.did), std::abs(column.should)) > noise;
    const bool stands = nothing_goes && std::abs(column.should) > noise;
    if (column.is_of_size && !(std::abs(column.back) <= kShareOfStep * size + noise))
      throw DeviceFault(
          FaultKind::kMoved, "instruments",
          fmt::format(
              "behind a short way and back {} is by {:.4g} (SI) another than at the reading: did a zero jump?",
              column.name, column.back));
    if (column.is_of_size ? !is_elsewhere : !is_against && !stands) continue;
    throw DeviceFault(FaultKind::kMoved, "instruments",
                      fmt::format("beside the reading the axes went a short way, in which {} went {:.4g} of the "
                                  "{:.4g} (SI) that it should: is a "
                                  "sign, a unit or a channel another, or does anything stand?",
                                  column.name, column.did, column.should));
  }
  RequireSteady(columns, LargestStep(columns));
}

/// A gain or a roll that changed by less than shows in one step.
void StepProof::RequireSteady(const std::vector<ColumnInStep>& columns, double step) {
  constexpr std::size_t kLast = 4, kFewestBefore = 8;
  constexpr double kMuchWhereItGoes = 0.05, kMuchWhereItStands = 0.01, kTimesScatter = 6.0;
  for (const ColumnInStep& column : columns) {
    const bool stands = column.should == 0.0;
    if (!column.is_of_size || step == 0.0 || (!stands && std::abs(column.should) < 0.5 * std::abs(step))) continue;
    const double of = stands ? step : column.should;
    std::vector<double>& went = went_[column.name];
    went.push_back(column.did / of);
    if (went.size() < kLast + kFewestBefore) continue;
    const Eigen::Map<const Eigen::ArrayXd> all(went.data(), std::ssize(went));
    const auto before = all.head(all.size() - kLast);
    const auto n = static_cast<double>(before.size());
    const double scatter = std::sqrt((before - before.mean()).square().sum() / (n - 1.0));
    const double noise = std::numbers::sqrt2 * column.noise / std::abs(of);
    const double allowed = kTimesScatter * std::max(scatter, noise) * std::sqrt(1.0 / kLast + 1.0 / n);
    const double last = all.tail(kLast).mean(), off = std::abs(last - before.mean());
    if (!(off > std::max(allowed, stands ? kMuchWhereItStands : kMuchWhereItGoes))) continue;
    throw DeviceFault(
        FaultKind::kChanged, "instruments",
        fmt::format("beside the last {} readings {} went {:.4g} of a short step, and {:.4g} beside those "
                    "before: has a gain or a roll changed? What was measured since is to be measured "
                    "again, in another run",
                    kLast, column.name, last, before.mean()));
  }
}

Reading ShownBeside(MachineBench& bench, std::vector<double>& by, const MachineOptions& options) {
  const std::vector<double> here = CommandedOf(bench);
  std::vector<double> there;
  for (std::size_t k = 0; k < here.size(); ++k) {
    const AxisLimits limits = LimitsOf(options.axes, k);
    if (here[k] + by[k] < limits.lower || here[k] + by[k] > limits.upper) by[k] = -by[k];
    there.push_back(here[k] + by[k]);
  }
  GoStraight(bench, there, options);
  const Reading shown = bench.instruments.Look();
  GoStraight(bench, here, options);
  return shown;
}

Reading ShownAgain(MachineBench& bench, double away_rad, Duration dwell, const MachineOptions& options) {
  const std::vector<double> here = CommandedOf(bench);
  const AxisLimits limits = LimitsOf(options.axes, 0);
  std::vector<double> away = here;
  away[0] = std::clamp(here[0] + away_rad, limits.lower, limits.upper);  // a nulled face stands beside its plan
  GoStraight(bench, away, options);
  GoStraight(bench, here, options);
  WaitFor(bench, dwell, options);
  return bench.instruments.Look();
}

void ComeAgain(RotaryBench& bench, double away_rad, Duration dwell, const Options& options) {
  const std::array<double, 2> here_rad = {bench.target.State().commanded_rad,
                                          bench.reference.State().commanded_rad};
  const std::array<double, 2> there_rad = {here_rad[0] + away_rad, here_rad[1] - away_rad};
  MoveBoth(bench, there_rad[0], there_rad[1], options, here_rad);
  MoveBoth(bench, here_rad[0], here_rad[1], options, there_rad);
  WaitFor(bench, dwell, options);
}

void LookBeside(RotaryBench& bench, double& yaw_rad, const Options& options, const std::function<void()>& look) {
  const std::array<double, 2> here_rad = {bench.target.State().commanded_rad,
                                          bench.reference.State().commanded_rad};
  const auto there_rad = [&] { return std::array{here_rad[0] + 2.0 * yaw_rad, here_rad[1] - yaw_rad}; };
  const auto is_beyond = [](double at_rad, const TableLimits& limits) {
    return at_rad < limits.lower_rad || at_rad > limits.upper_rad;
  };
  if (is_beyond(there_rad()[0], options.target) || is_beyond(there_rad()[1], options.reference)) yaw_rad = -yaw_rad;
  const std::array<double, 2> away_rad = there_rad();
  MoveBoth(bench, away_rad[0], away_rad[1], options, here_rad);
  look();
  MoveBoth(bench, here_rad[0], here_rad[1], options, away_rad);
}

}  // namespace twinbench::procedure
