#include "twin/benches/circular_motion/estimators/far_radii.h"

#include <cmath>

#include "twin/benches/circular_motion/columns.h"
#include "twin/core/units.h"

namespace twinbench::separate::circular {

std::vector<FarOnCourse> TakeOutFar(std::vector<Reading>& readings) {
  constexpr double kLeast_m = 1e-9, kBehindReversal = 5.0;  // steps
  const auto radius = [](const Reading& r) { return std::optional(OnCourse{r.reading, r.target_rad, benches::circular::DeviationOf(r).radial_m}); };
  const auto turns_round = [](double angle_rad, double step_rad) {
    return std::abs(std::remainder(angle_rad, 0.5 * units::kPi)) < kBehindReversal * step_rad;
  };
  return separate::TakeOutFar(readings, radius, kLeast_m, turns_round);
}

}  // namespace twinbench::separate::circular
