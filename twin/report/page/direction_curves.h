#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "twin/report/page/figure.h"

namespace twinbench::report {

/// Puts the errors in both directions in the place of their mean, where the results have the difference of the directions by
/// position (`reversal`): what a table shows forward or backward is never its mean. The mean stays beside its truth.
void ShowDirections(const nlohmann::json& results, std::vector<Figure>& curves);

/// The error of what a separation gives order by order, as a curve against the angle: the sum of its waves, a series a direction.
/// u: the orders as independent of each other.
std::vector<Figure> SummedCurves(const nlohmann::json& results);

}  // namespace twinbench::report
