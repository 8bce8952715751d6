#pragma once

#include <vector>

#include "twin/benches/rotary_4dof/estimators/separate.h"

namespace twinbench::separate {

/// Standard uncertainty of each order's amplitude in one component of a table, whatever its phase [rad, m]: with
/// a = 2/n sum x cos(k theta) and b likewise with the sine (half of that at k = n/2), sqrt((u_a^2 + u_b^2) / 2), random
/// and systematic together.
/// @return orders 1 to n/2; NaN where a position is not determined.
std::vector<double> HarmonicUncertainties(const TableEstimate& estimate, Component component);

}  // namespace twinbench::separate
