#pragma once

#include "mechanics/gear_train.h"
#include "mechanics/speed_command.h"

/// What both fidelities of the gear train share: the laws of its gears.
namespace twinbench::mechanics {

class GearLaw {
 public:
  explicit GearLaw(const GearTrainParameters& parameters);

  /// Where the worm holds the wheel and how fast, for the motor's angle over the worm's ratio.
  AngleSeries Wheel(double nominal_rad) const;
  /// What the electronic gearbox commands, for the angle of the machine's hob encoder.
  AngleSeries Command(double hob_motor_rad) const;
  /// End of the spindle, for the same.
  AngleSeries Spindle(double hob_motor_rad) const;

 private:
  double ratio_;
  std::function<AngleSeries(double)> correction_;
  std::vector<AngleHarmonic> wheel_;  // all gears of the table by orders of the table
  std::vector<AngleHarmonic> hob_encoder_;
  std::vector<AngleHarmonic> hob_drive_;
};

/// Motion of y(x) for a motion of x; its third derivative is left out.
inline Motion Along(const AngleSeries& y, const Motion& x) {
  return {y.value_rad, y.slope * x.rad_s, y.slope * x.rad_s2 + y.bend_1_rad * x.rad_s * x.rad_s, 0.0};
}

/// Makers behind MakeGearTrain.
std::unique_ptr<GearTrain> MakeKinematicGearTrain(const GearTrainParameters& parameters);
std::unique_ptr<GearTrain> MakeBulletGearTrain(const GearTrainParameters& parameters);

}  // namespace twinbench::mechanics
