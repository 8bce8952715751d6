#pragma once

#include <nlohmann/json_fwd.hpp>

#include "twin/report/page/figure.h"

namespace twinbench::report {

/// Residuals of every channel against every circumstance, before and after the extension.
/// @param plots  `plots` of a diagnosis in results.json: means of bins with their standard uncertainty, and a value for every position
///               of every set-up.
/// @return first the figure of which the extension explains most, or, where nothing was extended, the one that differs most from
///         nothing.
PageChoice ResidualChoice(const nlohmann::json& plots);

}  // namespace twinbench::report
