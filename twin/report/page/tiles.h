#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "twin/report/page/figure.h"

namespace twinbench::report {

/// What a reader of a run looks for first: the largest error with U in any direction of the first curve and that direction's rms
/// (without a curve the largest of a map), G(b) of circles, how errors compare with their u (where the run was scored), the verdict
/// of the diagnosis, what the design does not separate. What does not exist has no tile.
///
/// @param results  results.json.
/// @param score    score.json; null if the run was not scored.
/// @param curves   CurveFigures of both.
std::vector<PageTile> TilesOf(const nlohmann::json& results, const nlohmann::json& score, const std::vector<Figure>& curves);

}  // namespace twinbench::report
