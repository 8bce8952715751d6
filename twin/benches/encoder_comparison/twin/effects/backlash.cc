#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// Where the follower stands in the gap is its state. A gap that is crossed over another way than its width is one
/// with a soft end: a rubber, a belt, a wound-up shaft.
double Crossing_rad(const EffectSettings& e) {
  const double crossed_over_rad = Parameter(e, "crossed_over");
  return crossed_over_rad > 0.0 ? crossed_over_rad : std::abs(Parameter(e, "width"));
}

/// Play (Prandtl): the device's shaft rests until the gap is crossed and is then dragged along, half the gap
/// behind. With a negative width the reference is the one that is dragged.
class Gap : public AngleEffect {
 public:
  explicit Gap(const EffectSettings& e)
      : half_rad_(0.5 * Crossing_rad(e)),
        factor_(half_rad_ > 0.0 ? 0.5 * Parameter(e, "width") / half_rad_ : 0.0),
        start_(Parameter(e, "start")),
        approach_(Parameter(e, "approach")) {}
  void Advance(const AngleMoment& moment) override {
    if (!started_) follower_rad_ = moment.shaft_rad + start_ * half_rad_;
    started_ = true;
    Drag(moment.shaft_rad - approach_ * moment.approach_rad);
    Drag(moment.shaft_rad);
  }
  double ShaftError_rad(const AngleMoment& moment) const override {
    return factor_ * (follower_rad_ - moment.shaft_rad);
  }

 private:
  void Drag(double shaft_rad) {
    follower_rad_ = std::clamp(follower_rad_, shaft_rad - half_rad_, shaft_rad + half_rad_);
  }

  double half_rad_, factor_, start_, approach_;
  double follower_rad_ = 0.0;
  bool started_ = false;
};

}  // namespace

AngleEffectPointer MakeGap(const EffectSettings& settings) {
  return std::make_unique<Gap>(settings);
}

}  // namespace twinbench::sim
