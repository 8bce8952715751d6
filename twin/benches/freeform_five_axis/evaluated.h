#pragma once

#include "twin/benches/freeform_five_axis/estimators/volumetric.h"
#include "twin/core/scenario.h"

namespace twinbench::benches::freeform {

/// Poses of the readings that have every value.
/// @throws InputError if they are fewer than 12.
std::vector<estimators::PoseRead> SeenPoses(const Scenario& scenario, const std::vector<Reading>& readings);

estimators::Identification IdentifyBy(const FreeformSettings& bench, const std::vector<estimators::PoseRead>& poses,
                                      Estimator estimator);

/// Root mean square of the lengths of columns.
double RmsLength(const Eigen::Matrix3Xd& vectors);

}  // namespace twinbench::benches::freeform
