#pragma once

#include <vector>

#include "twin/benches/circular_motion/twin/live.h"

namespace twinbench::test {

/// What the scenario's twin reads.
inline std::vector<Reading> CircleReadings(const Scenario& scenario) {
  const sim::CircleRun run(scenario);
  std::vector<Reading> readings;
  for (int k = 0; k < run.Readings(); ++k) readings.push_back(run.Take(k));
  return readings;
}

}  // namespace twinbench::test
