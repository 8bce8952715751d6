#pragma once

#include <memory>
#include <vector>

#include "twin/diagnose/engine/base.h"

namespace twinbench::diagnose {

/// Steps (model::Step) at each of `onsets`, on the one channel of a bench: their sums are running sums.
/// @param reading  Numbers of the readings, ascending.
/// @param onsets   Numbers of readings at which something may begin.
std::shared_ptr<const Base> StepBase(const std::vector<int>& reading, const std::vector<double>& onsets);

}  // namespace twinbench::diagnose
