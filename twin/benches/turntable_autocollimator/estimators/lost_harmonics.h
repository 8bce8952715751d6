#pragma once

#include <vector>

#include "twin/benches/turntable_autocollimator/estimators/stops.h"

/// What the shifts of the multi-tooth table against the turntable cannot tell apart.
namespace twinbench::separate::turntable {

/// Greatest common divisor of n and all differences of the shifts [steps]; n for a single shift. An error that
/// repeats every so many steps looks the same on both tables.
int CommonSteps(int n, const std::vector<int>& shifts);

/// The same for set-ups that use several rows of teeth: only shifts along the same row count.
int CommonSteps(const StopGrid& grid);

/// Orders 1 to n / 2 of n positions that no shift separates: k with k s = 0 (mod n) for every difference s of two
/// shifts, which are the multiples of n / CommonSteps. The constants are always lost and not listed.
/// Reference: docs/theory.md 2.
std::vector<int> LostHarmonics(int n, int common_steps);

}  // namespace twinbench::separate::turntable
