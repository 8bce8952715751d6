#pragma once

#include "tests/foreign/angle_fault.h"
#include "tests/foreign/stand_fault.h"

/// Angle devices and rotary benches with faults, and in order; and the sets of them.
namespace twinbench::foreign {

/// A fault with the length of what it shows on all channels, in units of noise, offsets and constants of the set-ups
/// apart. Free unknowns of the rotary bench take a further part of it, which depends on the fault.
template <class Kind>
struct Wanted {
  Kind kind;
  double rho;
};

Machine MakeAngleMachine(std::uint64_t seed, bool in_motion, const std::vector<Wanted<AngleKind>>& wanted);

/// Nothing wrong.
/// @param stops_per_turn  0: as drawn.
Machine MakeAngleInOrder(std::uint64_t seed, bool in_motion, const NoiseShape& noise, int stops_per_turn);

Machine MakeStand(std::uint64_t seed, const std::vector<Wanted<StandKind>>& wanted);

/// Nothing wrong.
Machine MakeStandInOrder(std::uint64_t seed, const NoiseShape& noise, int positions);

/// Every kind that the catalogue lacks, `each` times: angle devices at stops and in motion in turn, rotary benches.
std::vector<Plan> KindPlans(int each, std::uint64_t first_seed);

/// Two or three causes of the catalogue, or one or two with a weaker one that it lacks; of seven, two are rotary
/// benches.
std::vector<Plan> SeveralPlans(int count, std::uint64_t first_seed);

/// Nothing wrong: every stress in turn, and as many with plain noise and 8 to 360 positions. Of four, one is a
/// rotary bench.
std::vector<Plan> CleanPlans(int count, std::uint64_t first_seed);

/// Causes of the catalogue by a bench's twin, spread over its effects and places. Their other run is one of the
/// same bench on another day: these measure what is written of a cause, not how well it is found.
std::vector<Plan> TwinPlans(const std::string& bench, int count, std::uint64_t first_seed);

}  // namespace twinbench::foreign
