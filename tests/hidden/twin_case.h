#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/hidden/bench_runs.h"

namespace twinbench::hidden {

/// An effect that a case is to hide.
struct Wanted {
  std::string effect, where;
  double rho = kNaN;  // wanted length of its signature, in units of noise; not used if it has no size
};

/// The bench of one case with the wanted effects on.
Scenario HiddenBench(Design design, std::uint64_t seed, const std::vector<Wanted>& wanted, const SignatureScale& scale);

/// A run of the twin with the wanted effects on, to be diagnosed with the scenario that lacks them.
///
/// @param wanted  One or more; alike are the effects that cannot be told from the first.
/// @param scale   Of the same design.
Case MakeTwinCase(Design design, std::uint64_t seed, const std::vector<Wanted>& wanted,
                  const SignatureScale& scale);

}  // namespace twinbench::hidden
