#pragma once

#include "tests/foreign/angle_fault.h"
#include "tests/foreign/dice.h"
#include "tests/foreign/stand_fault.h"

/// Angle devices and rotary benches with faults, and in order.
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

/// A fault with the length of what it shows on all channels, in units of noise, constants of the set-ups apart.
/// The bench's free unknowns take a further part of it, which depends on the fault.
struct WantedStandFault {
  StandKind kind;
  double rho;
};

Machine MakeStand(std::uint64_t seed, const std::vector<WantedStandFault>& wanted);

/// Nothing wrong.
Machine MakeStandInOrder(std::uint64_t seed, const NoiseShape& noise, int positions);

}  // namespace twinbench::foreign
