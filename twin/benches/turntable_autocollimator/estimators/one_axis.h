#pragma once

#include <vector>

#include "twin/core/reading.h"

/// Autocollimators of one axis, and tables of readings, show x alone.
namespace twinbench::separate::turntable {

/// Whether any reading has a y.
bool ShowsTilt(const std::vector<Reading>& readings);

/// Where none has, the mirror is taken to lean nowhere: what its tilt makes of x, with the roll of the crosshair and in second order,
/// stays in x.
std::vector<Reading> WithTilt(std::vector<Reading> readings);

}  // namespace twinbench::separate::turntable
