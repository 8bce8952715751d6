#pragma once

#include <vector>

#include "twin/core/reading.h"

namespace twinbench::diagnose::encoder {

/// A reference that stands while the device is pushed to and fro within its play: which way is seen in the device
/// alone, which then stands on one of two sides and hardly between them. Nobody wrote down the direction; each stay
/// on one side becomes a pass that was approached from there.
/// @return the readings as they are, if that is not so.
std::vector<Reading> WithSides(std::vector<Reading> readings);

}  // namespace twinbench::diagnose::encoder
