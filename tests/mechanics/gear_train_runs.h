#pragma once

#include <cmath>
#include <memory>

#include "mechanics/gear_train.h"
#include "tests/mechanics/test_units.h"

/// Machines and runs that the tests of the gear train share.
namespace twinbench::mechanics {

inline constexpr Fidelity kBoth[] = {Fidelity::kKinematic, Fidelity::kBullet};
inline constexpr double kHobSpeed_rad_s = 50.0 * 2.0 * kPi / 60.0;
inline constexpr double kRamp_s = 2.0;

/// No friction, and drives that do not lag: what is left are the gears.
inline GearTrainParameters Frictionless() {
  GearTrainParameters p;
  p.friction.coulomb_Nm = 0.0;
  p.hob.feed_forward = p.motor.feed_forward = 1.0;
  return p;
}

inline GearErrors SomeErrors() {
  GearErrors e;
  e.worm_wheel = {{1.0, 8.0 * kArcsec, 0.3}, {2.0, 1.0 * kArcsec, -0.5}};
  e.worm = {{1.0, 2.0 * kArcsec, 0.7}};
  e.tooth_mesh = {{2.0, 0.5 * kArcsec, 2.0}};
  e.hob_drive = {{1.0, 3.0 * kArcsec, 1.1}};
  return e;
}

inline double TransmissionError_rad(const GearTrainParameters& p, const GearTrainState& s) {
  return s.table_rad - p.ratio * s.hob_rad;
}

/// A train that has run at constant speed for so long that its transients are gone: servo and torsion decay with
/// 0.72 x 2 pi 20 Hz and 0.03 x 80 Hz x 2 pi, e^-45 or better.
inline std::unique_ptr<GearTrain> Steady(Fidelity fidelity, const GearTrainParameters& p,
                                         double hob_speed_rad_s = kHobSpeed_rad_s) {
  auto train = MakeGearTrain(fidelity, p);
  train->Run(hob_speed_rad_s, kRamp_s);
  train->Advance(kRamp_s + 3.0);
  return train;
}

}  // namespace twinbench::mechanics
