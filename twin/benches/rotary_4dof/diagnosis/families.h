#pragma once

#include <string>
#include <vector>

#include "twin/benches/rotary_4dof/diagnosis/rotary_run.h"
#include "twin/diagnose/engine/family.h"
#include "twin/diagnose/engine/time_series.h"

/// Candidates for the rotary bench: every effect of the catalogue that leaves a linear trace, and generic shapes.
namespace twinbench::diagnose::rotary {

/// What the twin shows of a cause, times its course.
std::vector<Family> NamedFamilies(const RotaryRun& rotary, const Scenario& scenario, const TimeSeries& series);
std::vector<Family> UnknownFamilies(const RotaryRun& rotary, double reference_degC, const TimeSeries& series);

/// With the published equations as the model: which of their sensitivities are off (yaw, tilt).
std::vector<Family> ModelFamilies(const RotaryRun& rotary);

/// True for causes that are a wrong constant of the bench: large ones bend.
bool IsOfBench(const std::string& effect);

}  // namespace twinbench::diagnose::rotary
