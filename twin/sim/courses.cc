#include "twin/sim/courses.h"

#include <cmath>

#include "twin/sim/effect_parameter.h"

namespace twinbench::sim {

double DriftAt(const EffectSettings& effect, Time now) {
  const double t_s = ToSeconds(now), hours = t_s / units::hour;
  return Parameter(effect, "rate") * t_s * (1.0 + Parameter(effect, "curvature") * (1.0 - hours));
}

double StepAt(const EffectSettings& effect, int reading) {
  return reading < static_cast<int>(Parameter(effect, "at_reading")) ? 0.0 : Parameter(effect, "step");
}

double WaveAt(const EffectSettings& effect, Time now) {
  const double turns = Parameter(effect, "frequency") * ToSeconds(now);
  return Parameter(effect, "amplitude") * std::cos(2.0 * units::kPi * turns + Parameter(effect, "phase"));
}

}  // namespace twinbench::sim
