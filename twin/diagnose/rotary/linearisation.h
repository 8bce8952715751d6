#pragma once

#include <vector>

#include "twin/diagnose/rotary/rotary_run.h"
#include "twin/diagnose/rotary/stance.h"

/// What the bench shows at given unknowns, and how it changes with them.
namespace twinbench::diagnose::rotary {

/// Fills the motions and the residual of `rotary`.
///
/// @param stances          One a used reading.
/// @param x                The free unknowns (free_parameters.h); calibrated parameters do not enter: they stay at
/// what
///                         is believed, and only have columns.
/// @param without_effects  Beside the published equations, which know no effects: the twin without those of the
///                         scenario; null: there are none.
/// @throws InputError if the twin would show nothing where a reading has a value.
void Compare(const std::vector<Stance>& stances, const Eigen::VectorXd& x, const RotaryTwin* without_effects,
             RotaryRun& rotary);

/// Fills the unknowns' Jacobian there.
/// @param calibrated_too  Else their columns are empty, as in a fit that holds them.
void Linearise(const std::vector<Stance>& stances, bool calibrated_too, RotaryRun& rotary);

}  // namespace twinbench::diagnose::rotary
