#pragma once

#include <vector>

#include "twin/core/estimator.h"
#include "twin/diagnose/by_twin.h"
#include "twin/diagnose/compared.h"
#include "twin/diagnose/engine/family.h"
#include "twin/diagnose/unknown/design.h"

/// What the rotary bench says to the diagnosis by its twin.
namespace twinbench::benches::rotary {

/// Four gains, two rolls, two distances, wavelength, incidence, as well as they are known once a bench has been set up.
const std::vector<diagnose::TwinComparison::KnownConstant>& CalibratedConstants();

/// @param readings  Those that are compared. @param follow  The twin on the PSDs.
diagnose::TwinComparison ComparisonWith(const std::vector<Reading>& readings, const Scenario& scenario,
                                        Estimator estimator, const model::FollowMaker& follow);

/// The twin that follows the record, its channels referred to the PSDs' surfaces [m].
/// @param published  Of its light only equations 1-12 of Jywe et al. (2007) are believed, with what the scenario's
///                   effects do on top of them.
model::FollowMaker FollowOnPsds(bool published);

/// Of a sweep that the autocollimator sees, too.
bool IsInCalibration(const Reading& r);

/// Noise of every channel, its rounding, and in the calibration the autocollimator's.
void StateNoise(const std::vector<Reading>& used, const Scenario& scenario, diagnose::TwinComparison& comparison);
/// Median deviation of one sample over all channels, else what the scenario states.
double SampleNoise_V(const std::vector<Reading>& used, const Scenario& scenario);
/// Real samples always scatter; only a simulation states deviations of nothing.
bool IsNoiseFree(const std::vector<Reading>& used);

/// A table that was read backwards, or from one step too late, judged by the commanded angles, the scenario's shifts and
/// the direction of travel alone.
/// @param readings  Get the angles that they should have had.
std::vector<diagnose::Cause> UndoLabelBlunder(const Scenario& scenario, std::vector<Reading>& readings);

/// Causes with shapes that are too many to ask the twin for, or of more freedom than its own.
/// @param sample_V  Noise of one A/D sample. @param published  The sensitivities of the equations may be off, too.
std::vector<diagnose::Family> OwnFamilies(const diagnose::Compared& compared, const Scenario& scenario,
                                          double sample_V, bool published);

/// Structure without a name shows on motions of the grating, on channels, or on all of them.
void SetStructure(const diagnose::Compared& compared, const Scenario& scenario, diagnose::unknown::Design& design);

}  // namespace twinbench::benches::rotary
