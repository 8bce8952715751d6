#pragma once

#include "twin/core/scenario.h"

namespace twinbench::sim {

inline Scenario Quiet() {
  Scenario scenario;
  scenario.noise_free = true;
  return scenario;
}

}  // namespace twinbench::sim
