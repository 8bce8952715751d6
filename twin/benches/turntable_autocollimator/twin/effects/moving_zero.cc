#include <cmath>

#include "twin/benches/turntable_autocollimator/twin/effects/effects.h"
#include "twin/sim/courses.h"

namespace twinbench::sim {
namespace {

/// The zero of one axis as a function of the moment.
class MovingZero : public TurntableEffect {
 public:
  using Course = double (*)(const EffectSettings&, const TurntableMoment&);
  MovingZero(const EffectSettings& effect, Course course) : effect_(effect), course_(course) {}
  Eigen::Vector2d ReadingError_rad(const TurntableMoment& moment, const Eigen::Vector2d&) const override {
    return OnAxis(effect_.where, course_(effect_, moment));
  }

 private:
  EffectSettings effect_;
  Course course_;
};

double DriftingZero(const EffectSettings& e, const TurntableMoment& moment) {
  return DriftAt(e, moment.now);
}

/// The mounting creeps: logarithmic in time since it was made.
double CreepingZero(const EffectSettings& e, const TurntableMoment& moment) {
  return Parameter(e, "amplitude") *
         std::log1p(ToSeconds(moment.now - moment.mounted) / Parameter(e, "time_constant"));
}

double SteppingZero(const EffectSettings& e, const TurntableMoment& moment) {
  return StepAt(e, moment.reading);
}

double WavingZero(const EffectSettings& e, const TurntableMoment& moment) {
  return WaveAt(e, moment.now);
}

MovingZero::Course MovingZeroCourse(const std::string& effect) {
  if (effect == "autocollimator_drift") return DriftingZero;
  if (effect == "mount_creep") return CreepingZero;
  return effect == "slip" ? SteppingZero : WavingZero;
}

}  // namespace

TurntableEffectPointer MakeMovingZero(const EffectSettings& effect) {
  return std::make_unique<MovingZero>(effect, MovingZeroCourse(effect.name));
}

}  // namespace twinbench::sim
