#include <fmt/format.h>

#include <algorithm>

#include "twin/diagnose/rotary/signals.h"
#include "twin/diagnose/rotary/unknown_collector.h"

namespace twinbench::diagnose::rotary {
namespace {

/// Time from 0 to pi over the run.
Eigen::VectorXd Phase_rad(const Schedule& s) {
  const double begin_s = s.time_s.minCoeff(), duration_s = std::max(1.0, s.time_s.maxCoeff() - begin_s);
  return units::kPi * (s.time_s.array() - begin_s) / duration_s;
}

/// cos(k phase) / k^falling for k = 1, 2, ...: readings x count.
Eigen::MatrixXd CosineModes(const Eigen::VectorXd& phase_rad, int count, bool falling) {
  Eigen::MatrixXd modes(phase_rad.size(), count);
  for (int k = 1; k <= count; ++k) modes.col(k - 1) = (k * phase_rad.array()).cos() / (falling ? k : 1);
  return modes;
}

void AddWander(Collector& collect) {
  constexpr int kModes = 10, kModesTogether = 6, kModesOfWalk = 24;
  const Schedule& s = collect.schedule();
  const Eigen::VectorXd phase_rad = Phase_rad(s);
  const Eigen::MatrixXd modes = CosineModes(phase_rad, kModes, false);
  collect.Add(
      "wander", kModes, [modes](int g) { return Eigen::MatrixXd(modes.col(g)); },
      [](int g) { return fmt::format("slow wander locked to time, {} half periods a run", g + 1); });
  collect.Add("wander", modes.leftCols(kModesTogether), "slow wander locked to time");
  // A random walk by its cosine modes, amplitudes falling as 1 / k: the generic form of any slow wander.
  collect.AddOnPlaces(
      "wander", 1, [walk = CosineModes(phase_rad, kModesOfWalk, true)](int) { return walk; },
      [](int) { return std::string("random wander locked to time"); });
  const Eigen::MatrixXd slopes = Indicators(s.setup, InCircle(s)).array().colwise() * phase_rad.array();
  collect.Add("wander", slopes, "drift that differs from set-up to set-up, locked to time");
}

void AddRestarts(Collector& collect) {
  const std::vector<double> restarts_s = {10.0, 30.0, 100.0, 300.0, 1000.0, 3000.0};
  collect.Add(
      "restart", static_cast<int>(std::ssize(restarts_s)),
      [&s = collect.schedule(), restarts_s](int g) {
        return Eigen::MatrixXd(Unit(CreepSignal(s, restarts_s[static_cast<std::size_t>(g)])));
      },
      [restarts_s](int g) {
        return fmt::format("creep that restarts with every set-up, about {:.0f} s, locked to time",
                           restarts_s[static_cast<std::size_t>(g)]);
      });
}

void AddTemperature(Collector& collect) {
  const Schedule& s = collect.schedule();
  if (!s.temperature_degC.array().isFinite().any()) return;
  const std::vector<double> lags_s = {0.0, 300.0, 900.0, 2700.0};
  collect.Add(
      "temperature", static_cast<int>(std::ssize(lags_s)),
      [&s, &context = collect.context(), lags_s](int g) {
        return Eigen::MatrixXd(
            Unit(LaggedTemperature(s, context.reference_degC, lags_s[static_cast<std::size_t>(g)])));
      },
      [lags_s](int g) {
        return fmt::format("locked to temperature with a lag of {:.0f} s", lags_s[static_cast<std::size_t>(g)]);
      });
}

}  // namespace

void AddInTime(Collector& collect) {
  AddWander(collect);
  AddRestarts(collect);
  AddTemperature(collect);
}

}  // namespace twinbench::diagnose::rotary
