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
/// @param known_m  What effects show that the scenario already holds, by row.
void Linearise(const Scenario& scenario, const std::vector<Stance>& stances, const Eigen::VectorXd& x,
               const Eigen::VectorXd& known_m, RotaryRun& rotary);

}  // namespace twinbench::diagnose::rotary
