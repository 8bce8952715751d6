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

/// Effects that the readings of a case cannot tell from this one, itself included.
///
/// @param drawn  The bench of the case.
std::vector<std::string> AlikeOf(const EffectSettings& effect, const Scenario& drawn, const SignatureScale& scale);

/// A place of `convention` that only relabels the positions: free errors of both tables are the same under other
/// labels.
bool OnlyRelabels(const std::string& where);

}  // namespace twinbench::hidden
