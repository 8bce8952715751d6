#pragma once

#include <functional>
#include <string>

#include "twin/core/scenario.h"

namespace twinbench::uncertainty {

/// One thing that moves or scatters a twin's readings.
struct Contribution {
  std::string name;                        // "floor", "laser wavelength by temperature"
  std::function<void(Scenario&)> silence;  // takes it out of a scenario
};

}  // namespace twinbench::uncertainty
