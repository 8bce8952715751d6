#include "twin/benches/turntable_autocollimator/estimators/collimator_scale.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/turntable_autocollimator/settings.h"

namespace twinbench::separate::turntable {

Eigen::Vector2d MirrorAngles_rad(const Eigen::Vector2d& shown_rad, const Scenario& scenario) {
  const AutocollimatorSettings& instrument = TurntableOf(scenario).autocollimator;
  const double range_rad = instrument.range_rad;
  const double edge = TurntableOf(scenario).collimator.error_at_edge_rad / range_rad;
  const Eigen::Vector2d scaled_rad = shown_rad / (1.0 + instrument.gain_error);
  Eigen::Vector2d angle_rad = scaled_rad;
  constexpr int kSteps = 8;  // each is closer by the enlargement, a few per cent at most
  for (int step = 0; step < kSteps; ++step)
    angle_rad = scaled_rad / (1.0 + edge * angle_rad.squaredNorm() / (range_rad * range_rad));
  return angle_rad;
}

double BeamWalk_rad(const TurntableSettings& own, int setup, double turntable_rad) {
  const TurntableProcedureSettings& p = own.turntable_procedure;
  const int stated = std::clamp(setup, 0, p.SetUps() - 1);
  const double aside_m = p.Of(p.eccentricities_m, stated) * std::cos(turntable_rad + p.Of(p.tilt_azimuths_rad, stated));
  return -8.0 * own.mirror.flatness_m * aside_m / (own.mirror.width_m * own.mirror.width_m);
}

}  // namespace twinbench::separate::turntable
