#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace twinbench::report {

/// Calls `look(path, object)` with every object of a file, from the outside to the inside; an object of a list has the path
/// of the list. What a page has a section of its own for is not entered: "diagnosis", "uncertainty_budget".
void ForEachObject(const nlohmann::json& node,
                   const std::function<void(const std::string& path, const nlohmann::json& object)>& look);

}  // namespace twinbench::report
