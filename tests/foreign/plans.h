#pragma once

#include <string>
#include <vector>

#include "tests/foreign/machine.h"

/// The sets of foreign machines.
namespace twinbench::foreign {

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
