#pragma once

#include "twin/core/bench_format.h"
#include "twin/plausible/check.h"

namespace twinbench::plausible {

/// What contradicts itself in what readings say of when, where and how they were taken: positions and directions that the angles
/// are against; angles that nothing turns to in the time or that make no circle; clocks that stand; rows that are there twice; and
/// axes whose own encoders stood elsewhere.
void CheckLabels(const std::vector<Reading>& readings, const BenchFormat& bench, std::vector<Finding>& findings);

}  // namespace twinbench::plausible
