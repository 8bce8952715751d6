#pragma once

#include <string>
#include <vector>

#include "twin/core/scenario.h"

namespace twinbench::test {

/// The same scenario with other keys, each as on a command line: "turntable.backlash_arcsec=3".
inline Scenario Changed(const Scenario& scenario, const std::vector<std::string>& keys) {
  return ParseScenario(WriteScenario(scenario), "test.toml", ".", keys);
}

}  // namespace twinbench::test
