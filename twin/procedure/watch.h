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
void MoveBoth(RotaryBench& bench, double target_rad, double reference_rad, const Options& options);

/// Lets bench time pass in slices, so that an operator who says stop is heard.
void WaitFor(RotaryBench& bench, Duration duration, const Options& options);

/// Tells both tables to stop, whatever state the bench is in, and asks whether they do: the answer is the controllers',
/// read back within some seconds, and no encoder may have moved between two looks. One table that does not answer keeps
/// nobody from stopping the other. Never throws what the bench throws.
Standstill StopBoth(RotaryBench& bench);

/// Whether both tables stand: nothing is told to them, their controllers are asked twice, and no encoder may have moved
/// between the two looks.
/// @throws DeviceFault, BenchError where a controller does not answer.
Standstill WhetherBothStand(RotaryBench& bench);

/// @throws DeviceFault kStopped if the operator said so.
void HearOperator(const Options& options);

}  // namespace twinbench::procedure
