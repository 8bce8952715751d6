#pragma once

#include <optional>
#include <string>
#include <vector>

#include "twin/benches/rotary_4dof/estimators/calibrate.h"
#include "twin/benches/rotary_4dof/estimators/geometry.h"
#include "twin/benches/rotary_4dof/estimators/motion.h"
#include "twin/core/estimator.h"
#include "twin/core/reading.h"

/// Front door of the room: from the voltages of the PSDs to the motion of the grating at the laser spot.
namespace twinbench::measure {

/// Turns every reading into a motion, in the same order; results are in L for both estimators.
///
/// @param readings     Any phases; a reading whose status is not ok, or with a voltage that is NaN, gives a motion
///                     with a status, a reason and NaN values, never a number.
/// @param calibration  From Calibrate(); the published estimator uses only its published_l1_m.
/// @return one Motion a reading. Random covariance from the block's std / sqrt(n) and, where the noise is too small
/// to
///         average the A/D steps, the quantisation; covariance_known is false if std or n is missing or all is
///         zero.
///
/// kPublished: equations 1-12 of Jywe et al. (2007) as printed. kRigorous: exact vector grating model.
/// The published estimator removes the mean of dy in each set-up (its eq. 9); the rigorous one removes nothing.
/// Uncertainty: the systematic part holds gains and rolls. Not included: wavelength, PSD distances, non-linearity.
std::vector<Motion> Measure(const std::vector<Reading>& readings, const BenchGeometry& geometry,
                            const Calibration& calibration, Estimator estimator);

}  // namespace twinbench::measure
