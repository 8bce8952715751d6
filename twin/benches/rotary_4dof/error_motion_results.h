#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "twin/benches/rotary_4dof/estimators/measure.h"
#include "twin/benches/rotary_4dof/estimators/separate.h"

namespace twinbench::benches::rotary {

/// The error motions of both tables in the terms of ISO 230-7.
struct ErrorMotionResults {
  /// [{"table": "target", "motion": "radial_fixed_y", "values": {"total": {"value_um", "u_um", "bias_um", "u_parts"}, "synchronous",
  /// "asynchronous"}, "turns", "missing"}]
  nlohmann::json json;
  std::string text;  // for a person; empty if there is nothing to say
};

/// Synchronous: the separated curves about their least-squares circles (their first order is where grating and tables are mounted, and is not
/// told apart anyway). Asynchronous and total: the target's, with what every pass shows beyond the separated model, by the target's angle; scaled for the
/// unknowns that were fitted. Of both tables together, and of the readings' noise: nothing tells these apart.
///
/// The target's curves are in the laboratory: fixed sensitive direction. Where x and y are there, also along a direction that turns with the
/// rotor, and back for the reference, whose curves are in its rotor. Axial motion is read by no detector.
/// Uncertainty: separate::EvaluateErrorMotion; none above 720 positions.
ErrorMotionResults EvaluateErrorMotions(const separate::Separation& separation, const std::vector<measure::Motion>& motions);

}  // namespace twinbench::benches::rotary
