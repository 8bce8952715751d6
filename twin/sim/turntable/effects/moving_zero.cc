#include <cmath>

#include "twin/sim/turntable/effects/effects.h"

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

/// Linear plus a quadratic share that is zero at both ends of the first hour.
double Drift(const EffectSettings& e, const TurntableMoment& moment) {
  const double t_s = ToSeconds(moment.now);
  return Parameter(e, "rate") * t_s * (1.0 + Parameter(e, "curvature") * (1.0 - t_s / units::hour));
}

/// The mounting creeps: logarithmic in time since it was made.
double Creep(const EffectSettings& e, const TurntableMoment& moment) {
  return Parameter(e, "amplitude") *
         std::log1p(ToSeconds(moment.now - moment.mounted) / Parameter(e, "time_constant"));
}

double Step(const EffectSettings& e, const TurntableMoment& moment) {
  return moment.reading < static_cast<int>(Parameter(e, "at_reading")) ? 0.0 : Parameter(e, "step");
}

double Wave(const EffectSettings& e, const TurntableMoment& moment) {
  const double turns = Parameter(e, "frequency") * ToSeconds(moment.now);
  return Parameter(e, "amplitude") * std::cos(2.0 * units::kPi * turns + Parameter(e, "phase"));
}

MovingZero::Course CourseOf(const std::string& effect) {
  if (effect == "autocollimator_drift") return Drift;
  if (effect == "mount_creep") return Creep;
  return effect == "slip" ? Step : Wave;
}

}  // namespace

TurntableEffectPointer MakeMovingZero(const EffectSettings& effect) {
  return std::make_unique<MovingZero>(effect, CourseOf(effect.name));
}

}  // namespace twinbench::sim
