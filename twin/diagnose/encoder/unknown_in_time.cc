#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/units.h"
#include "twin/diagnose/encoder/collector.h"
#include "twin/diagnose/encoder/wave_grid.h"

namespace twinbench::diagnose::encoder {
namespace {

void AddWander(Collector& collect) {
  constexpr int kTerms = 8;
  const Eigen::VectorXd phase = units::kPi * Fraction(collect.context());
  Eigen::MatrixXd terms(phase.size(), kTerms);
  for (int k = 0; k < kTerms; ++k) terms.col(k) = ((k + 1) * phase.array()).cos();
  collect.Add("wander", terms, "slow wander locked to time");
  collect.Add(
      "wander", kTerms, [terms](int g) { return Eigen::MatrixXd(terms.col(g)); },
      [](int g) { return fmt::format("slow wander locked to time, {} half periods a run", g + 1); });
}

void AddTones(Collector& collect) {
  constexpr int kMost = 2000;
  const SignalContext& c = collect.context();
  const double duration_s = Duration_s(c);
  const double last_Hz = 0.5 * static_cast<double>(c.Readings()) / duration_s;
  // From two periods a run; slower ones are a wander. Half the resolution apart, or as close as can be afforded.
  const double first_Hz = 2.0 / duration_s, step_Hz = std::max(0.5 / duration_s, (last_Hz - first_Hz) / kMost);
  Shape frequency{"frequency", "Hz", 1.0, first_Hz, last_Hz, {}};
  for (int k = 0; first_Hz + k * step_Hz < last_Hz; ++k) frequency.value.push_back(first_Hz + k * step_Hz);
  const auto waves = std::make_shared<const WaveGrid>(2.0 * units::kPi * c.time_s, first_Hz, step_Hz,
                                                      static_cast<int>(frequency.value.size()));
  collect.AddOver(
      "tone", frequency,
      [time_s = c.time_s](const Eigen::VectorXd& f_Hz) { return Wave(2.0 * units::kPi * f_Hz[0] * time_s); },
      [values = frequency.value](int g) {
        return fmt::format("tone at {:.4g} Hz locked to time", values[static_cast<std::size_t>(g)]);
      },
      [waves](int g) { return waves->At(g); });
}

void AddStep(Collector& collect) {
  if (collect.Covered("slip")) return;
  constexpr Eigen::Index kMost = 2500;
  const SignalContext& c = collect.context();
  std::vector<int> onsets;
  for (Eigen::Index i = 1; i < c.Readings(); i += 1 + c.Readings() / kMost) onsets.push_back(c.reading[i]);
  collect.Add(
      "step", static_cast<int>(onsets.size()),
      [c, onsets](int g) { return Eigen::MatrixXd(StepSignal(c, onsets[static_cast<std::size_t>(g)])); },
      [onsets](int g) {
        return fmt::format("step at reading {} locked to time", onsets[static_cast<std::size_t>(g)]);
      });
}

void AddTrends(Collector& collect) {
  const SignalContext& c = collect.context();
  if (!collect.Covered("drift")) collect.Add("trend", Unit(Fraction(c)), "linear trend locked to time");
  if (!collect.Covered("scale"))
    collect.Add("trend", Unit(c.reference_rad), "linear trend locked to reference angle, same in both directions");
}

}  // namespace

void AddInTime(Collector& collect) {
  const SignalContext& c = collect.context();
  AddStep(collect);
  AddTrends(collect);
  if (TimeFollowsAngle(c)) return;
  AddWander(collect);
  AddTones(collect);
  AddModulated(collect, "growing harmonic", std::min(24, LargestOrder(c)), Fraction(c),
               "order {} locked to reference angle that grows with time");
}

}  // namespace twinbench::diagnose::encoder
