#pragma once

#include <vector>

#include "twin/benches/rotary_4dof/estimators/measure.h"
#include "twin/benches/rotary_4dof/estimators/separate.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/report/error_motion_json.h"
#include "twin/report/evaluation.h"

/// What Bench::evaluate has for readings of one kind.
namespace twinbench::benches::rotary {

/// As Bench::evaluate, of readings of displacement probes and tilt meters: error motions of the target in the terms
/// of ISO 230-7, and of its artefact what reversal or several probes separate.
report::Evaluation EvaluateProbes(const Scenario& scenario, const std::vector<Reading>& readings);

/// The error motions of both tables in the terms of ISO 230-7, and what they are not.
///
/// Synchronous: the separated curves about their least-squares circles (their first order is where grating and tables are mounted, and is not
/// told apart anyway). Asynchronous and total: the target's, with what every pass shows beyond the separated model, by the target's angle; scaled for the
/// unknowns that were fitted. Of both tables together, and of the readings' noise: nothing tells these apart.
///
/// The target's curves are in the laboratory: fixed sensitive direction. Where x and y are there, also along a direction that turns with the
/// rotor, and back for the reference, whose curves are in its rotor. Axial motion is read by no detector.
/// Uncertainty: separate::EvaluateErrorMotion; none above 720 positions.
report::ErrorMotionTexts EvaluateErrorMotions(const separate::Separation& separation, const std::vector<measure::Motion>& motions);

}  // namespace twinbench::benches::rotary
