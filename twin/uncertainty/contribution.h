#pragma once

#include <functional>
#include <string>

#include "twin/core/scenario.h"

namespace twinbench::uncertainty {

/// One thing that moves or scatters a twin's readings.
struct Contribution {
  std::string name;                        // "floor", "laser wavelength by temperature"
  std::function<void(Scenario&)> silence;  // takes it out of a scenario
  /// Electronics: without their noise a converter rounds what is small away, so that they stay where others are
  /// alone.
  bool stays = false;
};

}  // namespace twinbench::uncertainty
