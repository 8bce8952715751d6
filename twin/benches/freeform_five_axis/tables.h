#pragma once

#include <string>
#include <vector>

#include "twin/benches/freeform_five_axis/estimators/volumetric.h"

/// Results as files for other programs.
namespace twinbench::benches::freeform {

/// One row a pose: where it is, the tip's error there and its standard uncertainty.
std::string VolumetricCsv(const std::vector<estimators::PoseRead>& poses,
                          const estimators::VolumetricErrors& errors);

/// What a controller takes off: the six errors of each axis at nodes over the range that was measured, and the
/// squareness errors. Of errors that the readings do not tell apart it is the least that explains them.
std::string CompensationCsv(const FreeformSettings& bench, const std::vector<estimators::PoseRead>& seen,
                            const estimators::Identification& found);

}  // namespace twinbench::benches::freeform
