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
  Scenario copy = scenario, usual = FourInputs({});
  return NumbersAt(copy, InputKeys()[k])[0] - NumbersAt(usual, InputKeys()[k])[0];
}

}  // namespace twinbench::test
