#include <cmath>

#include "mechanics/steady_gear_train.h"

namespace twinbench::mechanics {
namespace {

class KinematicGearTrain : public GearTrain {
 public:
  explicit KinematicGearTrain(const GearTrainParameters& p)
      : steady_(p), grid_(ToNanoseconds(p.servo_period_s)), play_(2.0 * steady_.half_play_rad(), Wheel(0).rad) {}

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
    const Motion wheel = Wheel(now_);
    const Motion spindle = steady_.Spindle(HobMotor(now_));
    const double rests_rad = Backlash(play_).Follow(wheel.rad);
    const double pull_rad = wheel.rad - rests_rad;
    constexpr double kRounding_rad = 1e-12;
    const bool dragged = std::copysign(1.0, wheel.rad_s) * pull_rad >= steady_.half_play_rad() - kRounding_rad;
    const double table_rad_s = dragged ? wheel.rad_s : 0.0;
    return {ToSeconds(now_), spindle.rad, spindle.rad_s, rests_rad - steady_.viscous_s() * table_rad_s,
            table_rad_s,     wheel.rad,   wheel.rad_s};
  }

 private:
  Motion HobMotor(Nanoseconds time) const { return steady_.HobMotor(command_.At(time)); }
  Motion Wheel(Nanoseconds time) const { return steady_.Wheel(HobMotor(time)); }

  SteadyGearTrain steady_;
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
