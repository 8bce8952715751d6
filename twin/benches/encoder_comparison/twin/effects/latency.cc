#include "twin/benches/encoder_comparison/twin/effects/effects.h"
#include "twin/model/first_order_lag.h"

namespace twinbench::sim {
namespace {

/// The device's reading is older than the reference's; on a clock that runs fast more and more so.
class Late : public AngleEffect {
 public:
  /// @param per_s  By how much the age grows.
  Late(double age_s, double per_s) : begin_s_(age_s), per_s_(per_s) {}
  double Age_s(const AngleMoment& moment) const override { return begin_s_ + per_s_ * ToSeconds(moment.now); }

 private:
  double begin_s_, per_s_;
};

/// A filter, or a servo in proportion to how far it is behind: the device goes towards the shaft the faster the farther it is.
class Lagging : public Late {
 public:
  Lagging(double age_s, double lag_s) : Late(age_s, 0.0), follower_(lag_s) {}
  void Advance(const AngleMoment& moment) override {
    // From one measuring position to the next it has settled.
    const bool stands = moment.velocity_rad_s == 0.0 && last_.velocity_rad_s == 0.0;
    const bool is_elsewhere = stands && moment.shaft_rad != last_.shaft_rad;
    if (!has_begun_ || moment.setup != last_.setup || is_elsewhere)
      follower_.BeginInMotion(ToSeconds(moment.now), moment.shaft_rad, moment.velocity_rad_s);
    behind_rad_ = follower_.Next(ToSeconds(moment.now), moment.shaft_rad) - moment.shaft_rad;
    last_ = moment;
    has_begun_ = true;
  }
  double Behind_rad(const AngleMoment&) const override { return behind_rad_; }

 private:
  model::FirstOrderLag follower_;
  AngleMoment last_;
  double behind_rad_ = 0.0;
  bool has_begun_ = false;
};

}  // namespace

AngleEffectPointer MakeLatency(const EffectSettings& settings) {
  const double delay_s = Parameter(settings, "delay"), lag_s = Parameter(settings, "time_constant");
  if (lag_s > 0.0) return std::make_unique<Lagging>(delay_s, lag_s);
  return std::make_unique<Late>(delay_s, 0.0);
}

AngleEffectPointer MakeClockRate(const EffectSettings& settings) {
  return std::make_unique<Late>(0.0, Parameter(settings, "ratio"));
}

}  // namespace twinbench::sim
