#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "twin/benches/rotary_4dof/settings.h"
#include "twin/core/scenario_uncertainty.h"
#include "twin/uncertainty/budget.h"
#include "twin/uncertainty/monte_carlo.h"

namespace twinbench::test {

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

inline double SquareOfFirst(const Scenario& s) {
  return std::pow(1e3 * Input(s, 0), 2);
}

/// As many trials as said.
inline uncertainty::MonteCarloOptions Trials(int trials, const std::vector<uncertainty::Joint>& joints = {}) {
  uncertainty::MonteCarloOptions options;
  options.most_trials = trials;
  options.digits = 3;
  options.joints = joints;
  return options;
}

}  // namespace twinbench::test
