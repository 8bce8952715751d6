#pragma once

#include "twin/benches/hob_transmission/settings.h"
#include "twin/core/devices.h"
#include "twin/core/scenario.h"
#include "twin/procedure/options.h"

/// How the bench hob_transmission is measured: the chain runs, and a card keeps both encoders' counts at edges of
/// the table's encoder.
namespace twinbench::procedure {

/// For each head position, speed and direction: runs up, keeps `turns` turns of samples, runs down and rests. The
/// samples of a look into the FIFO become readings together; each is numbered, and its position is its place in the
/// pass. Where the interferometer is read at rest, the first set-up ends with a turn of stops in each direction of
/// its passes, every one approached in that direction.
///
/// @throws BenchError from the devices; DeviceFault (overrun) when the FIFO ran full, which the settings can avoid,
///         and (stalled) when no edge comes. What was appended before stays in the sink.
/// Reference: Tan et al., section 1 and figure 1; the interferometer at stops as in their section 4.
void CarryOut(HobBench& bench, const Scenario& scenario, ReadingSink& sink, const ProgressCallback& progress = {});

int PlannedReadings(const HobSettings& bench);

}  // namespace twinbench::procedure
