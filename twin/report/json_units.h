#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/core/units.h"
#include "twin/core/written_number.h"

/// SI values as numbers of a file. NaN, not available, is null in JSON.
namespace twinbench::report {

inline nlohmann::json In(double unit, double value) {
  return std::isfinite(value) ? nlohmann::json(WrittenNumber(value, unit)) : nlohmann::json();
}
inline nlohmann::json Arcsec(double angle_rad) {
  return In(units::arcsec, angle_rad);
}

}  // namespace twinbench::report
