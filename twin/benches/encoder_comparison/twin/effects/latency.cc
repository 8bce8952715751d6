#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// The device's reading is older than the reference's, so that it is behind by what the shaft moved meanwhile: in
/// proportion to the speed, less what it has gained of that since. The acceleration is known from reading to
/// reading and is not followed further back than that.
class Latency : public AngleEffect {
 public:
  explicit Latency(const EffectSettings& e) : delay_s_(Parameter(e, "delay")), age_s_(std::abs(delay_s_)) {}
  void Advance(const AngleMoment& moment) override {
    const double step_s = started_ ? ToSeconds(moment.now - last_) : 0.0;
    const double gained_rad_s = moment.velocity_rad_s - last_rad_s_;
    second_order_rad_ = step_s > 0.0 ? 0.5 * age_s_ * std::min(age_s_, step_s) * gained_rad_s / step_s : 0.0;
    last_ = moment.now;
    last_rad_s_ = moment.velocity_rad_s;
    started_ = true;
  }
  double ShaftError_rad(const AngleMoment& moment) const override {
    return second_order_rad_ - moment.velocity_rad_s * delay_s_;
  }

 private:
  double delay_s_, age_s_;
  double second_order_rad_ = 0.0, last_rad_s_ = 0.0;
  Time last_{};
  bool started_ = false;
};

}  // namespace

AngleEffectPointer MakeLatency(const EffectSettings& settings) {
  return std::make_unique<Latency>(settings);
}

}  // namespace twinbench::sim
