#pragma once

#include <vector>

#include "twin/core/reading.h"

namespace twinbench::diagnose::encoder {

/// One turn in one pass without a clock, as a table of a device lists it, whose error ends as it began. What would go on beyond the
/// turn, a wrong scale or a slip, would be seen where it closes.
bool IsClosedTurn(const std::vector<Reading>& readings);

}  // namespace twinbench::diagnose::encoder
