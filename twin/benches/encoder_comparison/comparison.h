#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "twin/benches/encoder_comparison/axis_unit.h"
#include "twin/benches/encoder_comparison/estimators/angle_comparison.h"

namespace twinbench::benches::encoder {

/// What an angle comparison found before anything is diagnosed, as text for a person.
std::string Summary(const measure::AngleComparison& comparison, const AxisUnit& unit);

/// What results.json has of it.
nlohmann::json ToJson(const measure::AngleComparison& comparison);

}  // namespace twinbench::benches::encoder
