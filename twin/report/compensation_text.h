#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "twin/separate/compensation.h"

namespace twinbench::report {

/// What a compensation does and refuses to do, for a person.
std::string CompensationText(const separate::IndexErrors& errors, const separate::Compensation& compensation);
std::string CompensationCheckText(const separate::CompensationCheck& check);

/// compensation.json: lines with their fates and what they could be as well, rms before and predicted, the check if
/// there is one.
nlohmann::json CompensationJson(const separate::IndexErrors& errors, const separate::Compensation& compensation,
                                const separate::CompensationCheck* check);

/// What stands in the table's file.
std::vector<std::string> CompensationComments(const separate::IndexErrors& errors,
                                              const separate::Compensation& compensation,
                                              const std::string& source);

/// "1-3, 18, 90"
std::string OrderRanges(const std::vector<int>& orders);

}  // namespace twinbench::report
