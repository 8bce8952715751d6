#pragma once

#include "twin/core/table_errors.h"

namespace twinbench {

struct HarmonicSettings {
  Component component = Component::kEz;
  double order = 1.0;
  double amplitude = 0.0;                            // rad or m: amplitude * cos(order * angle + phase)
  double phase_rad = 0.0;
};

}  // namespace twinbench
