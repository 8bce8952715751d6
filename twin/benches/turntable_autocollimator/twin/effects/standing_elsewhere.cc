#include <cmath>

#include "twin/benches/turntable_autocollimator/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// The turntable stays behind by half of a gap, in whichever direction it comes.
class TurntableBacklash : public TurntableEffect {
 public:
  explicit TurntableBacklash(const EffectSettings& e) : width_rad_(Parameter(e, "width")) {}
  double Yaw_rad(const TurntableMoment& moment) const override { return -0.5 * moment.direction * width_rad_; }

 private:
  double width_rad_;
};

/// The turntable still creeps to its place after the move: behind by `amplitude`, decaying exponentially.
class TurntableSettling : public TurntableEffect {
 public:
  explicit TurntableSettling(const EffectSettings& e)
      : amplitude_rad_(Parameter(e, "amplitude")), time_constant_s_(Parameter(e, "time_constant")) {}
  double Yaw_rad(const TurntableMoment& moment) const override {
    const double since_s = ToSeconds(moment.now - moment.arrived);
    return -moment.direction * amplitude_rad_ * std::exp(-since_s / time_constant_s_);
  }

 private:
  double amplitude_rad_, time_constant_s_;
};

}  // namespace

TurntableEffectPointer MakeTurntableBacklash(const EffectSettings& effect) {
  return std::make_unique<TurntableBacklash>(effect);
}

TurntableEffectPointer MakeTurntableSettling(const EffectSettings& effect) {
  return std::make_unique<TurntableSettling>(effect);
}

}  // namespace twinbench::sim
