#include "mechanics/scale.h"

#include <cmath>

#include "mechanics/require.h"

namespace twinbench::mechanics {

double Interpolated_rad(const ScaleParameters& s, double angle_rad) {
  if (s.subdivision_rad == 0.0) return angle_rad;
  return angle_rad + s.subdivision_rad * std::sin(s.periods * angle_rad + s.subdivision_phase_rad);
}

double Shown_rad(const ScaleParameters& s, double angle_rad) {
  const double shown_rad = Interpolated_rad(s, angle_rad);
  return s.resolution_rad > 0.0 ? s.resolution_rad * std::round(shown_rad / s.resolution_rad) : shown_rad;
}

double AngleShowing_rad(const ScaleParameters& s, double shown_rad) {
  double angle_rad = shown_rad;
  for (int i = 0; i < 30; ++i) {  // Newton; the slope is between 0 and 2
    const double slope =
        1.0 + s.periods * s.subdivision_rad * std::cos(s.periods * angle_rad + s.subdivision_phase_rad);
    const double step_rad = (shown_rad - Interpolated_rad(s, angle_rad)) / slope;
    angle_rad += step_rad;
    if (std::abs(step_rad) < 1e-15) break;
  }
  return angle_rad;
}

void Check(const ScaleParameters& s) {
  RequireNotNegative(s.resolution_rad, "stack: scale.resolution_rad");
  Require(s.periods > 0, "stack: scale.periods must be positive");
  Require(std::abs(s.subdivision_rad) * s.periods < 0.9, "stack: scale.subdivision_rad turns the scale back");
}

}  // namespace twinbench::mechanics
