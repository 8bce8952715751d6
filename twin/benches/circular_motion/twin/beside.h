#pragma once

#include <vector>

#include "twin/benches/circular_motion/twin/live.h"
#include "twin/sim/environment.h"

namespace twinbench::sim {

/// Readings that the procedure does not have, or not at that time, behind all that was taken: effects may remember.
class CircleBeside {
 public:
  /// @param run    Outlives this.
  /// @param taken  So far, with its angles.
  CircleBeside(const CircleRun& run, std::vector<Reading> taken);

  /// @param commanded  What, when and how fast; its number says which noise it has.
  Reading Take(const Reading& commanded);

 private:
  const CircleRun& run_;
  std::vector<Reading> course_;
  Environment room_;
  BodiesOnce bodies_;  // of this course
  CircleTwin twin_;
};

}  // namespace twinbench::sim
