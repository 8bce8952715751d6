#include "mechanics/gear_train.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "mechanics/gear_law.h"
#include "mechanics/require.h"

namespace twinbench::mechanics {
namespace {

void CheckDrive(const DriveParameters& drive, double period_s) {
  RequirePositive(drive.inertia_kg_m2, "gear train: inertia_kg_m2 of a drive");
  RequirePositive(drive.servo_Hz, "gear train: servo_Hz");
  Require(drive.feed_forward >= 0.0 && drive.feed_forward <= 1.0,
          "gear train: feed_forward must be between 0 and 1");
  Require(40.0 * drive.servo_Hz * period_s <= 1.0, "gear train: servo_period_s must be at most 1 / (40 servo_Hz)");
}

void CheckFriction(const FrictionParameters& f) {
  RequireNotNegative(f.coulomb_Nm, "gear train: friction.coulomb_Nm");
  RequireNotNegative(f.viscous_Nm_s, "gear train: friction.viscous_Nm_s");
  RequirePositive(f.static_ratio, "gear train: friction.static_ratio");
  RequirePositive(f.stribeck_rad_s, "gear train: friction.stribeck_rad_s");
  RequirePositive(f.presliding_rad, "gear train: friction.presliding_rad");
  RequireNotNegative(f.bristle_damping_ratio, "gear train: friction.bristle_damping_ratio");
}

double Steepness(const std::vector<AngleHarmonic>& harmonics, double turns, const char* name) {
  Check(harmonics, std::string("gear train: errors.") + name);
  double sum = 0.0;
  for (const AngleHarmonic& h : harmonics) sum += std::abs(turns * h.order * h.amplitude_rad);
  return sum;
}

void CheckErrors(const GearTrainParameters& p) {
  const double hob = 1.0 / std::abs(p.ratio);
  const double sum =
      Steepness(p.errors.worm_wheel, 1.0, "worm_wheel") + Steepness(p.errors.worm, p.WormRatio(), "worm") +
      Steepness(p.errors.tooth_mesh, p.worm_wheel_teeth, "tooth_mesh") +
      Steepness(p.errors.hob_drive, hob, "hob_drive") + Steepness(p.errors.hob_encoder, hob, "hob_encoder");
  Require(sum < 0.5, "gear train: errors must leave the gears turning forwards");
}

/// Value and slope of the cubic Hermite polynomial at share s of a piece of length h.
struct Hermite {
  double from, from_slope, to, to_slope;  // slopes times h

  double At(double s) const {
    const double rest = 1.0 - s;
    return from + s * s * (3.0 - 2.0 * s) * (to - from) + s * rest * (rest * from_slope - s * to_slope);
  }
  double SlopeAt(double s) const {
    const double rest = 1.0 - s;
    return 6.0 * s * rest * (to - from) + rest * (1.0 - 3.0 * s) * from_slope + s * (3.0 * s - 2.0) * to_slope;
  }
};

void Set(const Hermite& piece, double s, double h_s, double& rad, double& rad_s) {
  rad = piece.At(s);
  rad_s = piece.SlopeAt(s) / h_s;
}

}  // namespace

void Check(const GearTrainParameters& p) {
  Require(std::isfinite(p.ratio) && p.ratio != 0.0, "gear train: ratio must not be zero");
  Require(p.worm_wheel_teeth > 0 && p.worm_starts > 0,
          "gear train: worm_wheel_teeth and worm_starts must be positive");
  RequirePositive(p.servo_period_s, "gear train: servo_period_s");
  RequirePositive(p.step_s, "gear train: step_s");
  CheckDrive(p.hob, p.servo_period_s);
  CheckDrive(p.motor, p.servo_period_s);
  RequirePositive(p.table_inertia_kg_m2, "gear train: table_inertia_kg_m2");
  RequirePositive(p.stiffness_Nm_rad, "gear train: stiffness_Nm_rad");
  RequireNotNegative(p.damping_ratio, "gear train: damping_ratio");
  RequireNotNegative(p.backlash_rad, "gear train: backlash_rad");
  CheckFriction(p.friction);
  CheckErrors(p);
}

GearTrainState Between(const GearTrainState& a, const GearTrainState& b, double time_s) {
  const double h_s = b.time_s - a.time_s;
  if (h_s == 0.0) return b;
  const double s = (time_s - a.time_s) / h_s;
  GearTrainState at;
  at.time_s = time_s;
  Set({a.hob_rad, h_s * a.hob_rad_s, b.hob_rad, h_s * b.hob_rad_s}, s, h_s, at.hob_rad, at.hob_rad_s);
  Set({a.table_rad, h_s * a.table_rad_s, b.table_rad, h_s * b.table_rad_s}, s, h_s, at.table_rad, at.table_rad_s);
  Set({a.wheel_rad, h_s * a.wheel_rad_s, b.wheel_rad, h_s * b.wheel_rad_s}, s, h_s, at.wheel_rad, at.wheel_rad_s);
  return at;
}

std::optional<double> PassingTime_s(const GearTrainState& a, const GearTrainState& b, double table_rad) {
  const double way_rad = b.table_rad - a.table_rad;
  const double sense = std::copysign(1.0, way_rad);
  const double left_rad = sense * (table_rad - a.table_rad);
  if (left_rad <= 0.0 || left_rad > std::abs(way_rad)) return std::nullopt;
  const double h_s = b.time_s - a.time_s;
  // Measured from `before`: an angle of many turns would cost digits.
  const Hermite piece = {0.0, sense * h_s * a.table_rad_s, std::abs(way_rad), sense * h_s * b.table_rad_s};
  double low = 0.0, high = 1.0, s = left_rad / std::abs(way_rad);
  for (int i = 0; i < 60 && high - low > 1e-15; ++i) {
    const double over_rad = piece.At(s) - left_rad;
    (over_rad > 0.0 ? high : low) = s;
    const double newton = s - over_rad / piece.SlopeAt(s);
    if (std::abs(newton - s) < 1e-15) break;
    s = newton > low && newton < high ? newton : 0.5 * (low + high);
  }
  return a.time_s + s * h_s;
}

std::unique_ptr<GearTrain> MakeGearTrain(Fidelity fidelity, const GearTrainParameters& parameters) {
  Check(parameters);
  if (fidelity == Fidelity::kKinematic) return MakeKinematicGearTrain(parameters);
  if (fidelity == Fidelity::kBullet) return MakeBulletGearTrain(parameters);
  throw std::invalid_argument("gear train: there is a kinematic and a bullet fidelity, no linear one");
}

}  // namespace twinbench::mechanics
