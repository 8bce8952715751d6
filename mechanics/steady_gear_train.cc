#include "mechanics/steady_gear_train.h"

#include "mechanics/position_loop.h"

namespace twinbench::mechanics {
namespace {

double LagOf(const DriveParameters& drive, const GearTrainParameters& p) {
  return PositionLoop(drive.inertia_kg_m2, drive.servo_Hz, drive.feed_forward, p.servo_period_s).lag_s();
}

Motion Lagging(const Motion& m, double lag_s) {
  return {m.rad - lag_s * m.rad_s, m.rad_s - lag_s * m.rad_s2, m.rad_s2 - lag_s * m.rad_s3, 0.0};
}

}  // namespace

SteadyGearTrain::SteadyGearTrain(const GearTrainParameters& p)
    : law_(p),
      hob_lag_s_(LagOf(p.hob, p)),
      table_lag_s_(LagOf(p.motor, p)),
      half_play_rad_(0.5 * p.backlash_rad + p.friction.coulomb_Nm / p.stiffness_Nm_rad),
      viscous_s_(p.friction.viscous_Nm_s / p.stiffness_Nm_rad) {}

Motion SteadyGearTrain::HobMotor(const Motion& command) const {
  return Lagging(command, hob_lag_s_);
}

Motion SteadyGearTrain::Spindle(const Motion& hob_motor) const {
  return Along(law_.Spindle(hob_motor.rad), hob_motor);
}

Motion SteadyGearTrain::Wheel(const Motion& hob_motor) const {
  const Motion nominal = Lagging(Along(law_.Command(hob_motor.rad), hob_motor), table_lag_s_);
  return Along(law_.Wheel(nominal.rad), nominal);
}

double SteadyGearTrain::Table_rad(double spindle_rad, double hob_speed_rad_s, double side) const {
  constexpr int kIterations = 4;  // each leaves a thousandth: errors are smooth over their own size
  double motor_rad = spindle_rad;
  for (int k = 0; k < kIterations; ++k) motor_rad += spindle_rad - law_.Spindle(motor_rad).value_rad;
  const Motion wheel = Wheel({motor_rad, hob_speed_rad_s, 0.0, 0.0});
  return wheel.rad - side * half_play_rad_ - viscous_s_ * wheel.rad_s;
}

}  // namespace twinbench::mechanics
