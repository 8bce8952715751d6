#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "twin/benches/turntable_autocollimator/estimators/collimator_sweep.h"
#include "twin/benches/turntable_autocollimator/estimators/indexing.h"
#include "twin/core/estimator.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/report/error_motion_json.h"
#include "twin/report/evaluation.h"

/// What Bench::evaluate and Bench::score have for runs of one kind.
namespace twinbench::benches::turntable {

// As Bench::evaluate and Bench::score, of a run with a polygon.

report::Evaluation EvaluatePolygon(const Scenario& scenario, const std::vector<Reading>& readings,
                                   Estimator estimator);
report::ScoredRun ScorePolygon(const Scenario& scenario, const std::vector<Reading>& readings,
                               const nlohmann::json& truth, Estimator estimator);

/// Takes single readings of a sweep out that lie far from their neighbours, and says so.
/// @return the others, and all that are of no sweep.
std::vector<Reading> WithoutFarOfSweep(std::vector<Reading> readings, report::Evaluation& evaluation);

/// Adds what a sweep says of the autocollimator to results.json (`autocollimator`) and the summary.
void AddSweep(const separate::turntable::CollimatorSweep& sweep, report::Evaluation& evaluation);

/// The tilt of the turntable in the terms of ISO 230-7: the autocollimator's y, free of the roll of its crosshair, in one direction that is
/// fixed in the laboratory.
///
/// Of each set-up the least-squares circle by the turntable's angle is taken off, which is how the multi-tooth table's axis leans; what is
/// left is T(position) + R(tooth), and T is the contour. With one shift R is in it, which `missing` says. The turns are the passes: what each
/// shows beyond T and R, scaled for the unknowns that were fitted.
///
/// @param positions       n; 0: count them.
/// @param stated_noise_rad  Of the autocollimator: as much of the scatter is noise, the rest repeatability.
/// @return nothing above 720 positions, whose covariance takes long to draw from.
/// Uncertainty: scatter of the readings (separate::EvaluateErrorMotion). Not included: roll of the crosshair where it is not known, flatness of the mirror.
report::ErrorMotionTexts EvaluateTilt(const std::vector<separate::turntable::TurntableStop>& stops, int positions,
                                      const separate::turntable::IndexingSeparation& separation, double stated_noise_rad);

}  // namespace twinbench::benches::turntable
