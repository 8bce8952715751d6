#pragma once

#include <cmath>
#include <limits>

#include "tests/support/angle_benches.h"
#include "twin/core/estimator.h"
#include "twin/core/scenario_uncertainty.h"
#include "twin/report/evaluation.h"
#include "twin/uncertainty/budget.h"
#include "twin/uncertainty/monte_carlo.h"

/// Runs of any bench, small enough for a test, and their budgets.
namespace twinbench::test {

struct SmallBench {
  std::string file;
  std::vector<std::string> overrides;  // few readings, closed forms
};

/// Every bench, as its scenario has it but for the count of readings.
inline const std::vector<SmallBench>& SmallBenches() {
  static const std::vector<SmallBench> all = {
      {"rotary_4dof.toml",
       {"procedure.positions=12", "procedure.shifts=[0, 1, 5]", "mechanics.fidelity=kinematic",
        "optics.fidelity=closed", "adc.every_sample=false"}},
      {"turntable_autocollimator.toml",
       {"turntable_procedure.positions=12", "turntable_procedure.phases=[\"full_circle\"]",
        "turntable_procedure.passes=[1, -1, 1]"}},
      {"hob_transmission.toml", {"mechanics.fidelity=kinematic", "hob_procedure.samples_per_turn=100"}},
      {"circular_motion.toml", {"circular_procedure.points=60", "circular_procedure.stops=0"}},
      {"freeform_five_axis.toml", {"optics.fidelity=closed", "freeform_procedure.poses=60"}},
      {"encoder_comparison.toml", {"encoder_procedure.stops_per_turn=24"}}};
  return all;
}

inline Scenario Small(const SmallBench& bench, const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides = bench.overrides;
  overrides.insert(overrides.end(), more.begin(), more.end());
  return LoadScenario(ScenarioPath(bench.file), overrides);
}

inline std::vector<uncertainty::Quantity> QuantitiesFrom(const Scenario& scenario, const std::vector<Reading>& readings,
                                                         Estimator estimator = Estimator::kRigorous) {
  return uncertainty::QuantitiesOf(BenchOf(scenario).evaluate(scenario, readings, estimator).results);
}

inline std::vector<uncertainty::Budget> BudgetsOf(const Scenario& scenario) {
  const std::vector<Reading> readings = ReadingsOf(scenario);
  return uncertainty::Budgets(scenario, [&](const Scenario& changed) { return QuantitiesFrom(changed, readings); });
}

/// A scenario in which four distances are known so well; what else it says plays no part.
inline Scenario FourInputs(const std::vector<StatedUncertainty>& stated) {
  Scenario scenario = ParseScenario("bench = \"rotary_4dof\"\n", "four.toml", "");
  scenario.uncertainties = stated;
  return scenario;
}

inline const std::vector<std::string>& InputKeys() {
  static const std::vector<std::string> keys = {"psd_a.distance_mm", "psd_b.distance_mm", "psd_a.width_mm",
                                                "psd_b.width_mm"};
  return keys;
}

/// The value of an input [m], against what it is by default.
inline double Input(const Scenario& scenario, std::size_t k) {
  static const RotarySettings usual;
  const auto value_m = [k](const RotarySettings& own) {
    const PsdSettings& psd = k % 2 == 0 ? own.psd_a : own.psd_b;
    return k < 2 ? psd.distance_m : psd.width_m;
  };
  return value_m(RotaryOf(scenario)) - value_m(usual);
}

/// One quantity that is so computed.
inline uncertainty::Evaluate Computing(const std::string& name, const std::function<double(const Scenario&)>& value,
                                       double u = 0.0, double dof = std::numeric_limits<double>::infinity()) {
  return [=](const Scenario& s) { return std::vector<uncertainty::Quantity>{{name, value(s), u, dof}}; };
}

inline double SquareOfFirst(const Scenario& s) { return std::pow(1e3 * Input(s, 0), 2); }

/// As many trials as said.
inline uncertainty::MonteCarloOptions Trials(int trials, const std::vector<uncertainty::Joint>& joints = {}) {
  return {.most_trials = trials, .digits = 3, .joints = joints};
}

}  // namespace twinbench::test
