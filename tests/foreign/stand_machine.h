#pragma once

#include "tests/foreign/noise.h"
#include "tests/foreign/stand_fault.h"

/// Rotary benches with faults, and in order.
namespace twinbench::foreign {

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
