#pragma once

#include "tests/foreign/angle_fault.h"
#include "tests/foreign/noise.h"

/// Angle devices with faults, and in order.
namespace twinbench::foreign {

/// The faults that a machine is to have, each with the length of what it shows, in units of noise, offset apart.
struct WantedFault {
  AngleKind kind;
  double rho;
};

Machine MakeAngleMachine(std::uint64_t seed, bool in_motion, const std::vector<WantedFault>& wanted);

/// Nothing wrong.
/// @param stops_per_turn  0: as drawn.
Machine MakeAngleInOrder(std::uint64_t seed, bool in_motion, const NoiseShape& noise, int stops_per_turn);

}  // namespace twinbench::foreign
