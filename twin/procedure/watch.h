#pragma once

#include "twin/procedure/options.h"
#include "twin/procedure/standstill.h"

namespace twinbench::procedure {

/// Moves both tables together and returns when they have arrived.
///
/// @throws DeviceFault before any motion if a target lies outside its soft limits or a table stands on a limit
/// switch
///         and would be driven further (kLimit), or has lost its origin (kRestarted); during it if a table stands
///         still (kStalled), goes the wrong way (kFollowing), reports a fault (kRefused) or takes too long
///         (kNotInPosition); after it if the encoder is not where it was sent (kNotInPosition); kStopped if
///         the operator wants it.
/// @param sent_rad  Where we sent both before; NaN: unknown. A controller with another target is kMoved.
void MoveBoth(RotaryBench& bench, double target_rad, double reference_rad, const Options& options,
              const std::array<double, 2>& sent_rad = {kNaN, kNaN});

/// Lets bench time pass in slices, so that an operator who says stop is heard.
void WaitFor(RotaryBench& bench, Duration duration, const Options& options);

/// Brings both tables to rest, as BringToRest. One that does not answer keeps nobody from stopping the other.
Standstill StopBoth(RotaryBench& bench, const Options& options);

/// Whether both tables are at rest, as WhetherAtRest.
/// @throws DeviceFault, BenchError where a controller does not answer.
Standstill WhetherBothStand(RotaryBench& bench, const Options& options);

/// @throws DeviceFault kStopped if the operator said so.
void HearOperator(const Options& options);

}  // namespace twinbench::procedure
