#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "twin/plan/outlook.h"

namespace twinbench::plan {

/// Standard uncertainties by order, as benches write them into results.json:
///   a list of objects with `order` and `u_amplitude_...`;
///   an object with lists `order` and `u_amplitude_...`;
///   `u_harmonics`: an object with the list `order` and one list a component.
std::vector<HarmonicCertainty> HarmonicsOf(const nlohmann::json& results);

}  // namespace twinbench::plan
