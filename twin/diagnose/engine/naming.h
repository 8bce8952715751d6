#pragma once

#include <string>
#include <vector>

#include "twin/diagnose/diagnosis.h"
#include "twin/diagnose/engine/search.h"

namespace twinbench::diagnose {

/// From what the search found to the four kinds of answer.
struct Naming {
  Verdict verdict = Verdict::kNone;
  std::vector<Cause> causes;
  UnknownPart unknown;
};
/// @param noise_free  Readings of a simulation without noise show the last digit of every formula: a small rest of
///                    any kind is then no cause.
/// @param threshold   Of the alarm statistic: what remains above it is structure that the causes do not explain.
Naming Name(const SearchResult& found, const std::vector<Family>& families, double threshold,
            bool noise_free = false);

}  // namespace twinbench::diagnose
