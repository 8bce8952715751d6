#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "twin/report/page/figure.h"

namespace twinbench::report {

/// Errors at places in space: lists beside `x_mm`, `y_mm` and `z_mm` of their length, as columns whose points have the colour of an error.
std::vector<PageColumns> VolumetricColumns(const nlohmann::json& results);

}  // namespace twinbench::report
