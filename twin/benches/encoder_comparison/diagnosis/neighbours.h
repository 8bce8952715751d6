#pragma once

#include <cstddef>
#include <vector>

#include "twin/core/reading.h"

namespace twinbench::diagnose::encoder {

/// Means of as many neighbours each as leave about `enough`: of a table that goes one way without a clock, whose readings tell
/// nothing by their order. All of it counts then, where a part of the readings would mistake steep structure for another order.
/// A mean has the number of the first of its readings.
/// @return nothing where readings turn, have a clock, are missing, repeat their places, or are no more than half as many again.
std::vector<Reading> MeansOfNeighbours(const std::vector<Reading>& readings, std::size_t enough);

}  // namespace twinbench::diagnose::encoder
