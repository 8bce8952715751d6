#pragma once

#include "mechanics/gear_law.h"

namespace twinbench::mechanics {

/// The gear train without inertia, for motions that are given: exact ratio, errors of the gears, lag of the servos,
/// backlash and wind-up as one play between worm wheel and table. Where the play has its path, the kinematic gear
/// train keeps it; here somebody else says where in it the table is.
class SteadyGearTrain {
 public:
  explicit SteadyGearTrain(const GearTrainParameters& parameters);

  /// The hob's motor for what the hob was told.
  Motion HobMotor(const Motion& command) const;
  /// End of the spindle, and where the worm holds the wheel, for the motion of the hob's motor.
  Motion Spindle(const Motion& hob_motor) const;
  Motion Wheel(const Motion& hob_motor) const;

  /// Half of backlash and wind-up by Coulomb friction.
  double half_play_rad() const { return half_play_rad_; }
  /// What viscous friction winds up, by speed of the table.
  double viscous_s() const { return viscous_s_; }

  /// Table with the spindle at an angle and the hob's motor at constant speed.
  /// @param side  Of the play at which the wheel drags the table, 1 or -1 by the direction; in between it does not.
  double Table_rad(double spindle_rad, double hob_speed_rad_s, double side) const;

 private:
  GearLaw law_;
  double hob_lag_s_, table_lag_s_;
  double half_play_rad_, viscous_s_;
};

}  // namespace twinbench::mechanics
