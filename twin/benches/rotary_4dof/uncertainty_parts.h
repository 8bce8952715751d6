#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "twin/benches/rotary_4dof/analysis.h"
#include "twin/uncertainty/joint.h"

namespace twinbench::benches::rotary {

/// Adds `u_parts` to both tables of `separation` (separate::ToJson of this analysis): what blocks of samples scatter
/// by is noise and, as far as a step of the converter does it, quantisation; what passes scatter by beyond that
/// (Separation::scale) is repeatability, or noise where no block states any; and what gains and rolls, the model's second order and the published
/// equations leave.
///
/// The scale is that of the motion that a component is (dx: of dy). Steps of the converter count the same in all
/// channels, by the mean of their shares.
void AddParts(const Analysis& analysis, const std::vector<Reading>& readings, const Scenario& scenario,
              nlohmann::json& separation);

/// Adds `u_parts` to gains and rolls of `calibration` (ToJson of this analysis): noise of the detectors, of it steps of the converter; noise of the
/// autocollimator (standard); what was believed before.
void AddCalibrationParts(const Analysis& analysis, const std::vector<Reading>& readings, const Scenario& scenario,
                         nlohmann::json& calibration);

/// All values of a table together, by both of its covariances, in the units of separation.json.
std::vector<uncertainty::Joint> JointsOf(const separate::Separation& separation);

}  // namespace twinbench::benches::rotary
