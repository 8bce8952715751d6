#pragma once

#include <string>
#include <string_view>

namespace twinbench {

/// A unit of keys and columns as it is written in print: "µm/m" of "um_m", "m⁻²" of "per_m2", "°C" of "degC".
std::string UnitInPrint(std::string_view unit);

}  // namespace twinbench
