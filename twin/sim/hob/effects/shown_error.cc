#include <cmath>

#include "twin/sim/hob/effects/effects.h"

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

/// Linear plus a quadratic share that is zero at both ends of the first hour.
ShownError Drift(const EffectSettings& e, const HobMoment& moment) {
  const double t_s = ToSeconds(moment.now);
  return {.motion_rad = Parameter(e, "rate") * t_s * (1.0 + Parameter(e, "curvature") * (1.0 - t_s / units::hour))};
}

ShownError Step(const EffectSettings& e, const HobMoment& moment) {
  if (moment.reading < static_cast<int>(Parameter(e, "at_reading"))) return {};
  const double step_rad = Parameter(e, "step");
  return e.where == "table" ? ShownError{.table_rad = step_rad} : ShownError{.hob_rad = step_rad};
}

ShownError Wave(const EffectSettings& e, const HobMoment& moment) {
  const double turns = Parameter(e, "frequency") * ToSeconds(moment.now);
  return {.motion_rad = Parameter(e, "amplitude") * std::cos(2.0 * units::kPi * turns + Parameter(e, "phase"))};
}

ShownError OldAngle(const EffectSettings& e, const HobMoment& moment) {
  return {.table_rad = -moment.velocity_rad_s * Parameter(e, "delay")};
}

CountError::Course CourseOf(const std::string& effect) {
  if (effect == "drift") return Drift;
  if (effect == "slip") return Step;
  return effect == "tone" ? Wave : OldAngle;
}

}  // namespace

HobEffectPointer MakeShownError(const EffectSettings& effect) {
  return std::make_unique<CountError>(effect, CourseOf(effect.name));
}

}  // namespace twinbench::sim
