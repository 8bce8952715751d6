#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "twin/separate/far_on_course.h"

/// Readings that were left out because they lie far from the curve through their neighbours.
namespace twinbench::report {

/// A line each. @param which  Names it, with places for its number and its angle [deg].
std::string FarText(const std::vector<separate::FarOnCourse>& far, const char* which, const char* unit, double unit_SI);

/// @param off  The name of what it lies off by, with its unit.
nlohmann::json FarJson(const std::vector<separate::FarOnCourse>& far, const char* off, double unit_SI);

}  // namespace twinbench::report
