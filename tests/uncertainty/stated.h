#pragma once

#include <string>
#include <vector>

#include "twin/core/scenario_uncertainty.h"

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

/// The value of an input, against what it is by default.
inline double Input(const Scenario& scenario, std::size_t k) {
  static const std::vector<double> usual = [] {
    Scenario plain = FourInputs({});
    std::vector<double> values;
    for (const std::string& key : InputKeys()) values.push_back(NumbersAt(plain, key)[0]);
    return values;
  }();
  Scenario copy = scenario;
  return NumbersAt(copy, InputKeys()[k])[0] - usual[k];
}

}  // namespace twinbench::test
