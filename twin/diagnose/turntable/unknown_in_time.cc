#include <fmt/format.h>

#include <cmath>

#include "twin/core/units.h"
#include "twin/diagnose/turntable/collector.h"

namespace twinbench::diagnose::turntable {
namespace {

/// cos(k pi t) / k^falling over the run, k = 1, 2, ...: readings x count.
Eigen::MatrixXd CosineModes(const Schedule& s, int count, bool falling) {
  const Eigen::VectorXd phase_rad = units::kPi * Fraction(s);
  Eigen::MatrixXd modes(phase_rad.size(), count);
  for (int k = 1; k <= count; ++k) modes.col(k - 1) = (k * phase_rad.array()).cos() / (falling ? k : 1);
  return modes;
}

void AddWander(Collector& collect) {
  constexpr int kModes = 4, kModesTogether = 6, kModesOfWalk = 24;  // a single mode of more periods is a tone
  const Schedule& s = collect.schedule();
  const Eigen::MatrixXd modes = CosineModes(s, kModesTogether, false);
  collect.Add(
      "wander", kModes, [modes](int g) { return Eigen::MatrixXd(modes.col(g)); },
      [](int g) { return fmt::format("slow wander locked to time, {} half periods a run", g + 1); });
  collect.Add("wander", modes, "slow wander locked to time");
  // A random walk by its cosine modes, amplitudes falling as 1 / k: the generic form of any slow wander.
  collect.Add("wander", CosineModes(s, kModesOfWalk, true), "random wander locked to time");
  const Eigen::MatrixXd slopes = Times(Indicators(collect, s.setup), Fraction(s));
  collect.Add("wander", slopes, "drift that differs from set-up to set-up, locked to time");
}

void AddTrend(Collector& collect) {
  collect.Add("trend", Unit(Fraction(collect.schedule())), "linear trend locked to time");
}

/// A wave that grows with time, or that comes and goes with it.
void AddGrowing(Collector& collect) {
  const int last = LargestOrder(collect.turntable());
  if (last < 1) return;
  const Schedule& s = collect.schedule();
  const auto add = [&](const Eigen::VectorXd& factor, const std::string& what) {
    collect.Add(
        "growing harmonic", last,
        [c = collect.context(), factor](int g) { return Times(Wave((g + 1) * c->schedule.target_rad), factor); },
        [what](int g) { return fmt::format("order {} locked to target angle that grows with {}", g + 1, what); });
  };
  add(Unit(Fraction(s).array() - Fraction(s).mean()), "time");
  if (collect.context()->HasTemperature())
    add(Unit(collect.context()->above_K.array() - collect.context()->above_K.mean()), "temperature");
}

/// Exponentials that begin again with every set-up.
void AddRestarts(Collector& collect) {
  const std::vector<double> lifetimes_s = {30.0, 100.0, 300.0, 1000.0, 3000.0};
  collect.Add(
      "restart", static_cast<int>(std::ssize(lifetimes_s)),
      [c = collect.context(), lifetimes_s](int g) {
        const double lifetime_s = lifetimes_s[static_cast<std::size_t>(g)];
        return Eigen::MatrixXd(Unit((-c->since_mounting_s.array() / lifetime_s).exp()));
      },
      [lifetimes_s](int g) {
        return fmt::format("creep that begins again with every set-up, lifetime about {:.0f} s, locked to time",
                           lifetimes_s[static_cast<std::size_t>(g)]);
      });
}

void AddTemperature(Collector& collect) {
  if (!collect.context()->HasTemperature()) return;
  const std::vector<double> lags_s = {0.0, 300.0, 900.0, 2700.0};
  collect.Add(
      "temperature", static_cast<int>(std::ssize(lags_s)),
      [c = collect.context(), lags_s](int g) {
        const Eigen::VectorXd lagged_K = LaggedTemperature_K(*c, lags_s[static_cast<std::size_t>(g)]);
        return Eigen::MatrixXd(Unit(lagged_K.array() - lagged_K.mean()));
      },
      [lags_s](int g) {
        return fmt::format("locked to temperature with a lag of {:.0f} s", lags_s[static_cast<std::size_t>(g)]);
      });
  const Eigen::VectorXd behind_K = collect.context()->above_K - LaggedTemperature_K(*collect.context(), 600.0);
  collect.Add("temperature", Unit(behind_K), "locked to the rate of the temperature");
}

void AddTones(Collector& collect) {
  const std::vector<double> frequencies_Hz = ToneFrequencies_Hz(collect.schedule());
  collect.Add(
      "tone", static_cast<int>(std::ssize(frequencies_Hz)),
      [c = collect.context(), frequencies_Hz](int g) {
        return Wave(2.0 * units::kPi * frequencies_Hz[static_cast<std::size_t>(g)] * c->schedule.time_s);
      },
      [frequencies_Hz](int g) {
        return fmt::format("tone at {:.4g} Hz locked to time", frequencies_Hz[static_cast<std::size_t>(g)]);
      });
}

void AddSteps(Collector& collect) {
  std::vector<int> onsets;
  const Schedule& s = collect.schedule();
  const std::size_t every = 1 + s.reading.size() / 1000;
  for (std::size_t i = 1; i < s.reading.size(); i += every) onsets.push_back(s.reading[i]);
  collect.Add(
      "step", static_cast<int>(std::ssize(onsets)),
      [c = collect.context(), onsets](int g) {
        return Eigen::MatrixXd(StepSignal(*c, onsets[static_cast<std::size_t>(g)]));
      },
      [onsets](int g) {
        return fmt::format("step at reading {} locked to time", onsets[static_cast<std::size_t>(g)]);
      });
}

}  // namespace

void AddInTime(Collector& collect) {
  AddTrend(collect);
  AddWander(collect);
  AddGrowing(collect);
  AddRestarts(collect);
  AddTemperature(collect);
  AddTones(collect);
  AddSteps(collect);
}

}  // namespace twinbench::diagnose::turntable
