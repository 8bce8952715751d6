#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "twin/report/page/figure.h"

/// Circular paths as ISO 230-4 draws them, and the errors that make them.
namespace twinbench::report {

/// "mounting 0 (bar), 40 mm/min".
std::string CircleInWords(const nlohmann::json& circle);

/// Radial deviation about the commanded circle, both directions of a set-up and feed in one figure; that with the largest comes first.
///
/// @return no figures if the results hold no circles.
PageChoice CircleChoice(const nlohmann::json& results);

/// The errors of the machine and the instruments, those of both axes together, each with its share of the radial deviation: of the sum of the
/// mean squares that they make. Nothing is drawn or listed if the results do not say what each makes.
Figure ErrorRankFigure(const nlohmann::json& results);
PageTable ErrorRankTable(const nlohmann::json& results);

}  // namespace twinbench::report
