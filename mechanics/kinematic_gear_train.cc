#include <cmath>

#include "mechanics/gear_law.h"
#include "mechanics/position_loop.h"

namespace twinbench::mechanics {
namespace {

class KinematicGearTrain : public GearTrain {
 public:
  explicit KinematicGearTrain(const GearTrainParameters& p)
      : law_(p),
        hob_lag_s_(LagOf(p.hob, p)),
        table_lag_s_(LagOf(p.motor, p)),
        half_play_rad_(0.5 * p.backlash_rad + p.friction.coulomb_Nm / p.stiffness_Nm_rad),
        viscous_s_(p.friction.viscous_Nm_s / p.stiffness_Nm_rad),
        grid_(ToNanoseconds(p.servo_period_s)),
        play_(2.0 * half_play_rad_, Wheel(0).rad) {}

  void Run(double hob_speed_rad_s, double ramp_s) override {
    SpeedCommand next = command_;
    next.Run(hob_speed_rad_s, ramp_s, now_);
    play_.Follow(Wheel(now_).rad);
    command_ = next;
  }

  /// The play depends on where the wheel turned round, and it does so on ramps only. There its path is kept on a
  /// grid of fixed times, so that no slicing of time changes it.
  void Advance(double dt_s) override {
    const Nanoseconds before = now_;
    now_ += ToNanoseconds(dt_s);
    const Nanoseconds end = std::min(now_, command_.ramp_end());
    for (Nanoseconds t = (before / grid_ + 1) * grid_; t <= end; t += grid_) play_.Follow(Wheel(t).rad);
  }

  GearTrainState State() const override {
    const Motion hob_motor = HobMotor(now_);
    const Motion wheel = Wheel(now_);
    const Motion spindle = Along(law_.Spindle(hob_motor.rad), hob_motor);
    const double rests_rad = Backlash(play_).Follow(wheel.rad);
    const double pull_rad = wheel.rad - rests_rad;
    constexpr double kRounding_rad = 1e-12;
    const bool dragged = std::copysign(1.0, wheel.rad_s) * pull_rad >= half_play_rad_ - kRounding_rad;
    const double table_rad_s = dragged ? wheel.rad_s : 0.0;
    return {ToSeconds(now_), spindle.rad, spindle.rad_s, rests_rad - viscous_s_ * table_rad_s,
            table_rad_s,     wheel.rad,   wheel.rad_s};
  }

 private:
  static double LagOf(const DriveParameters& drive, const GearTrainParameters& p) {
    return PositionLoop(drive.inertia_kg_m2, drive.servo_Hz, drive.feed_forward, p.servo_period_s).lag_s();
  }

  static Motion Lagging(const Motion& m, double lag_s) {
    return {m.rad - lag_s * m.rad_s, m.rad_s - lag_s * m.rad_s2, m.rad_s2 - lag_s * m.rad_s3, 0.0};
  }

  Motion HobMotor(Nanoseconds time) const { return Lagging(command_.At(time), hob_lag_s_); }

  Motion Wheel(Nanoseconds time) const {
    const Motion hob = HobMotor(time);
    const Motion nominal = Lagging(Along(law_.Command(hob.rad), hob), table_lag_s_);
    return Along(law_.Wheel(nominal.rad), nominal);
  }

  GearLaw law_;
  double hob_lag_s_;
  double table_lag_s_;
  double half_play_rad_;
  double viscous_s_;
  Nanoseconds grid_;
  SpeedCommand command_;
  Backlash play_;
  Nanoseconds now_ = 0;
};

}  // namespace

std::unique_ptr<GearTrain> MakeKinematicGearTrain(const GearTrainParameters& parameters) {
  return std::make_unique<KinematicGearTrain>(parameters);
}

}  // namespace twinbench::mechanics
