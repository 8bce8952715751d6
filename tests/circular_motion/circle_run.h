#pragma once

#include "twin/benches/circular_motion/twin/live.h"

namespace twinbench::test {

/// What the scenario's twin reads.
inline std::vector<Reading> CircleReadings(const sim::CircleRun& run) {
  std::vector<Reading> readings;
  for (int k = 0; k < run.Readings(); ++k) readings.push_back(run.Take(k));
  return readings;
}
inline std::vector<Reading> CircleReadings(const Scenario& scenario) {
  return CircleReadings(sim::CircleRun(scenario));
}

}  // namespace twinbench::test
