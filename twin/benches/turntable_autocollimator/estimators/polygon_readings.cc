#include "twin/benches/turntable_autocollimator/estimators/polygon_readings.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "twin/benches/turntable_autocollimator/estimators/collimator_scale.h"
#include "twin/benches/turntable_autocollimator/estimators/tilt_squared.h"
#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/core/errors.h"

namespace twinbench::separate::turntable {
namespace {

int FaceOf(const Reading& r, const TurntableSettings& own) {
  const int faces = own.polygon.faces;
  const int face = static_cast<int>(std::lround(-r.reference_rad / own.Pitch_rad())) % faces;
  return face < 0 ? face + faces : face;
}

/// The mirror's yaw and tilt without scale and roll of the autocollimator.
Eigen::Vector2d Levelled_rad(const Reading& r, const Scenario& scenario) {
  const Eigen::Vector2d mirror_rad = MirrorAngles_rad({r.autocollimator_yaw_rad, r.autocollimator_tilt_rad}, scenario);
  return Eigen::Rotation2Dd(TurntableOf(scenario).collimator.roll_rad) * mirror_rad;
}

FaceReading FaceReadingOf(const Reading& r, const Scenario& scenario) {
  const TurntableSettings& own = TurntableOf(scenario);
  const std::string where = fmt::format("reading {}", r.reading);
  if (r.setup < 0 || r.setup >= own.turntable_procedure.SetUps())
    throw InputError(where, fmt::format("mounting {} has no offset of the polygon", r.setup),
                     fmt::format("mountings 0 to {}", own.turntable_procedure.SetUps() - 1));
  const int face = FaceOf(r, own);
  const double nominal_rad = own.FaceAngle_rad(r.setup, face);
  const double aside_rad = std::remainder(r.target_rad - nominal_rad, units::turn);
  if (!(std::abs(aside_rad) < 0.5 * own.Pitch_rad()))
    throw InputError(where, fmt::format("the encoder shows {:.4f} deg", r.target_rad / units::deg),
                     fmt::format("face {} near {:.4f} deg", face, nominal_rad / units::deg));
  const double x_rad = Levelled_rad(r, scenario).x();
  return {r.setup, face, r.direction, nominal_rad, x_rad - BeamWalk_rad(own, r.setup, nominal_rad) - aside_rad};
}

}  // namespace

std::vector<FaceReading> FaceReadings(const std::vector<Reading>& readings, const Scenario& scenario) {
  std::vector<FaceReading> faces;
  std::vector<TiltReading> tilts;
  for (const Reading& r : readings) {
    if (r.phase != Phase::kFullCircle || r.status != ReadingStatus::kOk) continue;
    const FaceReading& face = faces.emplace_back(FaceReadingOf(r, scenario));
    tilts.push_back({face.clamping, face.face, face.angle_rad, Levelled_rad(r, scenario).y()});
  }
  const Eigen::VectorXd of_tilt_rad = TiltSquared_rad(tilts);
  for (std::size_t i = 0; i < faces.size(); ++i) faces[i].value_rad -= of_tilt_rad[static_cast<Eigen::Index>(i)];
  return faces;
}

}  // namespace twinbench::separate::turntable
