#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "twin/report/page/figure.h"

namespace twinbench::report {

/// Numbers that stand alone in results.json, with their `u`, k and U = k u, and what the score says they should be.
PageTable ValueTable(const nlohmann::json& results, const nlohmann::json& score);

/// Results that are lists: how many, and their root mean square u with k and U.
PageTable ListTable(const nlohmann::json& results);

/// Which source has which share of the variance of each result of `uncertainty_budget`. No series if there is no budget.
Figure BudgetFigure(const nlohmann::json& results);

/// What cannot be separated, and why. No rows if all can.
PageTable NotSeparableTable(const nlohmann::json& results);

/// Lists of alike objects that hold plain numbers and words (set-ups, feeds, steps), a table each.
std::vector<PageTable> ObjectTables(const nlohmann::json& results);

/// What a reader of a run looks for first: the largest error with U in any direction of the first curve and that direction's rms
/// (without a curve the largest of a map), G(b) of circles, how errors compare with their u (where the run was scored), the verdict
/// of the diagnosis, what the design does not separate. What does not exist has no tile.
///
/// @param results  results.json.
/// @param score    score.json; null if the run was not scored.
/// @param curves   CurveFigures of both.
std::vector<PageTile> TilesOf(const nlohmann::json& results, const nlohmann::json& score, const std::vector<Figure>& curves);

}  // namespace twinbench::report
