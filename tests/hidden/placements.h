#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/hidden/bench_runs.h"

namespace twinbench::hidden {

/// An effect of the catalogue at one of its places, in a design that can show it.
struct Placement {
  std::string effect, where;
  Design design;
};

/// Every effect, place and design of a bench, in the order of the catalogue.
std::vector<Placement> Placements(const std::string& bench);

/// The designs of a bench without anything stated that few know.
std::vector<Design> PlainDesigns(const std::string& bench);

/// "rotary:psd_gain:psd_a_x:17": unique, and says what to expect before the case is made.
std::string CaseName(const Placement& placement, std::uint64_t seed);

}  // namespace twinbench::hidden
