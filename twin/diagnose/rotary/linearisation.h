#pragma once

#include <vector>

#include "twin/core/scenario.h"
#include "twin/diagnose/rotary/rotary_run.h"
#include "twin/diagnose/rotary/stance.h"

/// What the believed bench shows at given unknowns, and how it changes with them.
namespace twinbench::diagnose::rotary {

/// Fills the motions, the residual and the unknowns' Jacobian of `rotary` (exact chain of poses, exact grating
/// equation).
///
/// @param stances  One a used reading.
/// @param x        The free unknowns (free_parameters.h); calibrated parameters do not enter: they stay at what is
///                 believed, and only have columns.
/// @param twin     Says what every reading should have been; none: the closed forms do.
/// @throws InputError if the twin would show nothing where a reading has a value.
void Linearise(const Scenario& scenario, const std::vector<Stance>& stances, const Eigen::VectorXd& x,
               const model::Follow* twin, RotaryRun& rotary);

}  // namespace twinbench::diagnose::rotary
