#pragma once

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

/// Causes of the catalogue on the benches that have no foreign generator, `each` on every bench, by their twins:
/// they measure what is written of a cause, not how well it is found.
std::vector<Plan> TwinPlans(int each, std::uint64_t first_seed, const std::string& cache_folder);

}  // namespace twinbench::foreign
