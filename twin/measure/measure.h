#pragma once

#include <optional>
#include <string>
#include <vector>

#include "twin/core/reading.h"
#include "twin/measure/calibrate.h"
#include "twin/measure/geometry.h"
#include "twin/measure/motion.h"

/// Front door of the room: from the voltages of the PSDs to the motion of the grating at the laser spot.
namespace twinbench::measure {

/// kPublished: equations 1-12 of Jywe et al. (2007) as printed, for comparison. kRigorous: exact vector grating
/// model.
enum class Estimator { kPublished, kRigorous };
const char* EstimatorName(Estimator estimator);  // "published", "rigorous"
/// The estimator of that name; kRigorous if it is neither.
Estimator EstimatorNamed(const std::string& name);

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
/// The published estimator removes the mean of dy in each set-up (its eq. 9); the rigorous one removes nothing.
/// Uncertainty: the systematic part holds gains and rolls. Not included: wavelength, PSD distances, non-linearity.
std::vector<Motion> Measure(const std::vector<Reading>& readings, const BenchGeometry& geometry,
                            const Calibration& calibration, Estimator estimator);

}  // namespace twinbench::measure
