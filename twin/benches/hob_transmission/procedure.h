#pragma once

#include <vector>

#include "twin/benches/hob_transmission/settings.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/procedure/machine_sequencer.h"

/// What the bench hob_transmission is to read, and how it is driven: the chain runs, and a card keeps both encoders' counts at lines of the
/// table's encoder.
namespace twinbench::procedure {

/// Some turns at one speed, or one from stop to stop.
struct HobPass {
  int setup = 0, direction = 1;
  double hob_speed_rad_s = 0.0;  // with its sign; 0: stops
  int readings = 0;
};

/// For each head position, speed and direction `turns` turns of samples. Where the interferometer is read at rest, the
/// first set-up ends with a turn of stops in each direction of its passes.
/// Reference: Tan et al., section 1 and figure 1; the interferometer at stops as in their section 4.
std::vector<HobPass> HobPasses(const HobSettings& bench);

/// The readings of the passes in their order; a reading's position is its place in the pass. Times and angles are not
/// known before they are taken.
std::vector<Reading> HobSchedule(const HobSettings& bench);

int PlannedReadings(const HobSettings& bench);

/// Carries a scenario's passes out on any such bench: one rotary axis that turns on and on (the hob, whose drive takes
/// the table along), counters of both encoders that latch at lines of the table's.
///
/// A pass runs up, keeps its samples, runs down and rests; those of a look into the memory become readings together. At
/// stops every one is approached in the direction of the pass. A resumed real run makes the rest of a pass from wherever
/// the table stands.
/// @throws what CarryOutPlan throws; DeviceFault kRefused for a bench with other axes.
void DriveHob(MachineBench& bench, const Scenario& scenario, ReadingSink& sink, const ProgressCallback& progress,
              const MachineOptions& options);

}  // namespace twinbench::procedure
