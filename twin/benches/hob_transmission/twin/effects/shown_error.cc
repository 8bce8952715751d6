#include "twin/benches/hob_transmission/twin/effects/effects.h"
#include "twin/sim/courses.h"

namespace twinbench::sim {
namespace {

/// An error of the counts as a function of the moment.
class CountError : public HobEffect {
 public:
  using Course = ShownError (*)(const EffectSettings&, const HobMoment&);
  CountError(const EffectSettings& effect, Course course) : effect_(effect), course_(course) {}
  ShownError Shown(const HobMoment& moment) override { return course_(effect_, moment); }

 private:
  EffectSettings effect_;
  Course course_;
};

ShownError Drift(const EffectSettings& e, const HobMoment& moment) {
  return {.motion_rad = DriftAt(e, moment.now)};
}

ShownError Step(const EffectSettings& e, const HobMoment& moment) {
  const double step_rad = StepAt(e, moment.reading);
  return e.where == "table" ? ShownError{.table_rad = step_rad} : ShownError{.hob_rad = step_rad};
}

ShownError Wave(const EffectSettings& e, const HobMoment& moment) {
  return {.motion_rad = WaveAt(e, moment.now)};
}

ShownError OldAngle(const EffectSettings& e, const HobMoment& moment) {
  return {.table_rad = -moment.velocity_rad_s * Parameter(e, "delay")};
}

CountError::Course CountErrorCourse(const std::string& effect) {
  if (effect == "drift") return Drift;
  if (effect == "slip") return Step;
  return effect == "tone" ? Wave : OldAngle;
}

}  // namespace

HobEffectPointer MakeShownError(const EffectSettings& effect) {
  return std::make_unique<CountError>(effect, CountErrorCourse(effect.name));
}

}  // namespace twinbench::sim
