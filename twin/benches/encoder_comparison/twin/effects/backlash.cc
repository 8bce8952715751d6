#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// Play: the device's shaft rests until the gap is crossed and is then dragged along, half the gap behind. With a
/// negative width the reference is the one that is dragged.
class Gap : public AngleEffect {
 public:
  explicit Gap(const EffectSettings& e)
      : half_rad_(0.5 * std::abs(Parameter(e, "width"))), sign_(Parameter(e, "width") < 0.0 ? -1.0 : 1.0) {}
  void Advance(const AngleMoment& moment) override {
    if (!started_) follower_rad_ = moment.shaft_rad - half_rad_;  // as if it had come from below
    started_ = true;
    Drag(moment.shaft_rad - moment.approach_rad);
    Drag(moment.shaft_rad);
  }
  double ShaftError_rad(const AngleMoment& moment) const override {
    return sign_ * (follower_rad_ - moment.shaft_rad);
  }

 private:
  void Drag(double shaft_rad) {
    follower_rad_ = std::clamp(follower_rad_, shaft_rad - half_rad_, shaft_rad + half_rad_);
  }

  double half_rad_, sign_;
  double follower_rad_ = 0.0;
  bool started_ = false;
};

}  // namespace

AngleEffectPointer MakeGap(const EffectSettings& settings) {
  return std::make_unique<Gap>(settings);
}

}  // namespace twinbench::sim
