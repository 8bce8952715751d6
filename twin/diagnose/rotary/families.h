#pragma once

#include <string>
#include <vector>

#include "twin/diagnose/engine/family.h"
#include "twin/diagnose/engine/time_series.h"
#include "twin/diagnose/rotary/rotary_run.h"

/// Candidates for the rotary bench: every effect of the catalogue that leaves a linear trace, and generic shapes.
namespace twinbench::diagnose::rotary {

/// Families keep references to `rotary` and `context`, which must outlive them.
std::vector<Family> NamedFamilies(const RotaryRun& rotary, const SignalContext& context, const Scenario& scenario,
                                  const TimeSeries& series);
std::vector<Family> UnknownFamilies(const RotaryRun& rotary, const SignalContext& context,
                                    const TimeSeries& series);

/// With the published equations as the model: which of their sensitivities are off (yaw, tilt).
std::vector<Family> ModelFamilies(const RotaryRun& rotary);

}  // namespace twinbench::diagnose::rotary
