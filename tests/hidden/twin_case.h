#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "tests/hidden/bench_runs.h"

namespace twinbench::hidden {

/// An effect that a case is to hide.
struct Wanted {
  std::string effect, where;
  double rho = kNaN;  // wanted length of its signature, in units of noise; not used if it has no size
  std::map<std::string, double> parameters = {};  // SI, that are not drawn
};

/// What else of the bench is not as believed, without being wrong.
using Otherwise = std::function<void(Scenario& actual)>;

/// The bench of one case with the wanted effects on.
Scenario HiddenBench(Design design, std::uint64_t seed, const std::vector<Wanted>& wanted,
                     const SignatureScale& scale, const Otherwise& otherwise = {});

/// A run of the twin with the wanted effects on, to be diagnosed with the scenario that lacks them.
///
/// @param wanted  One or more; alike are the effects that cannot be told from the first.
/// @param scale   Of the same design.
Case MakeTwinCase(Design design, std::uint64_t seed, const std::vector<Wanted>& wanted, const SignatureScale& scale,
                  const Otherwise& otherwise = {});

}  // namespace twinbench::hidden
