#pragma once

#include <string>
#include <vector>

#include "twin/diagnose/engine/linear_run.h"

namespace twinbench::diagnose {

/// Far values that come by chance are scattered. Those that stand in a row, come back at one angle or wherever the
/// same value is shown have one reason (a dead zone, a missing code, a scratch on a scale), which nobody has named.
/// @param rows  That are far outside.
/// @return how they recur, in words; "" if chance may well have scattered them so.
std::string RecurrenceOf(const std::vector<int>& rows, const LinearRun& run);

}  // namespace twinbench::diagnose
