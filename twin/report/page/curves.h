#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
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

/// Puts the errors in both directions in the place of their mean, where the results have the difference of the directions by
/// position (`reversal`): what a table shows forward or backward is never its mean. The mean stays beside its truth.
void ShowDirections(const nlohmann::json& results, std::vector<Figure>& curves);

/// The error of what a separation gives order by order, as a curve against the angle: the sum of its waves, a series a direction.
/// u: the orders as independent of each other.
std::vector<Figure> SummedCurves(const nlohmann::json& results);

/// Adds the line below which noise alone stays with 95 % probability: cosine and sine part of an amplitude scatter by its u, so their root of the
/// sum of squares has Rayleigh's distribution. Of several series the largest; none without a u.
void AddNoiseLimit(Figure& spectrum);

/// What a curve at equal steps of a full circle is made of: a picture of the numbers that it shows, no estimate of its own.
///
/// @param curve  A figure of form kAngle.
/// @return amplitudes of orders 1 .. (n - 1)/2 of every series that goes round at n >= 8 equal steps without a gap; nothing if none
///         does. With the limit of noise; where no u of the orders is stated, that of points that are independent of each other.
std::optional<Figure> HarmonicsOf(const Figure& curve);

/// Errors at places in space: lists beside `x_mm`, `y_mm` and `z_mm` of their length, as columns whose points have the colour of an error.
std::vector<PageColumns> VolumetricColumns(const nlohmann::json& results);

}  // namespace twinbench::report
