#pragma once

#include <vector>

#include "twin/benches/rotary_4dof/diagnosis/configuration.h"
#include "twin/benches/rotary_4dof/diagnosis/rotary_run.h"

/// What the bench shows at given unknowns, and how it changes with them.
namespace twinbench::diagnose::rotary {

/// Fills the motions and the residual of `rotary`.
///
/// @param configurations          One a used reading.
/// @param x                The free unknowns (free_parameters.h); calibrated parameters do not enter: they stay at
/// what
///                         is believed, and only have columns.
/// @param without_effects  Beside the published equations, which know no effects: the twin without those of the
///                         scenario; null: there are none.
/// @throws InputError if the twin would show nothing where a reading has a value.
void Compare(const std::vector<Configuration>& configurations, const Eigen::VectorXd& x,
             const RotaryTwin* without_effects, RotaryRun& rotary);

/// Fills the unknowns' Jacobian there.
/// @param calibrated_too  Else their columns are empty, as in a fit that holds them.
void Linearise(const std::vector<Configuration>& configurations, bool calibrated_too, RotaryRun& rotary);

}  // namespace twinbench::diagnose::rotary
