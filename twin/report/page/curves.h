#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "twin/report/page/figure.h"

namespace twinbench::report {

/// Every curve of results.json: a list beside a `position_deg` (or `commanded_deg`) of its length is plotted against it, with
/// its `u_` as band and the truth of the score where there is one.
///
/// @param results  results.json, or a part of it.
/// @param score    score.json; null if there is none.
/// @return a figure a curve, in the order of the file. Passes round a circle are no curves of their own (CircleChoice).
std::vector<Figure> CurveFigures(const nlohmann::json& results, const nlohmann::json& score);

/// The coverage factor that the budget of results.json states for a result or a list of them; 2 if it has none.
double CoverageOf(const nlohmann::json& results, const std::string& path);

/// What the estimates of these curves are beside their truth, with the same u; a curve without truth has none.
std::vector<Figure> DeviationFigures(const std::vector<Figure>& curves);

/// Every spectrum: lists beside `order`, and lists of objects that have an `order` each.
std::vector<Figure> SpectrumFigures(const nlohmann::json& results, const nlohmann::json& score);

}  // namespace twinbench::report
