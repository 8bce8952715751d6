#pragma once

#include "twin/core/scenario.h"
#include "twin/core/time.h"

/// How effects of the same name on different benches go on with time and from reading to reading.
namespace twinbench::sim {

/// Of `rate` and `curvature`: linear plus a quadratic share that is zero at both ends of the first hour.
double DriftAt(const EffectSettings& effect, Time now);

/// Of `step` and `at_reading`: zero before that reading.
double StepAt(const EffectSettings& effect, int reading);

/// Of `amplitude`, `frequency` and `phase`: a cosine in time.
double WaveAt(const EffectSettings& effect, Time now);

}  // namespace twinbench::sim
