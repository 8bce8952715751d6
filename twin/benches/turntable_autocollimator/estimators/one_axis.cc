#include "twin/benches/turntable_autocollimator/estimators/one_axis.h"

#include <algorithm>
#include <cmath>

namespace twinbench::separate::turntable {

bool ShowsTilt(const std::vector<Reading>& readings) {
  return std::ranges::any_of(readings, [](const Reading& r) { return std::isfinite(r.autocollimator_tilt_rad); });
}

std::vector<Reading> WithTilt(std::vector<Reading> readings) {
  if (ShowsTilt(readings)) return readings;
  for (Reading& r : readings) r.autocollimator_tilt_rad = 0.0;
  return readings;
}

}  // namespace twinbench::separate::turntable
