#include "twin/report/page/walk.h"

#include <nlohmann/json.hpp>

namespace twinbench::report {
namespace {

using Look = std::function<void(const std::string&, const nlohmann::json&)>;

void Enter(const std::string& path, const nlohmann::json& node, const Look& look) {
  if (node.is_array()) {
    for (const nlohmann::json& element : node) Enter(path, element, look);
    return;
  }
  if (!node.is_object()) return;
  look(path, node);
  for (const auto& [key, value] : node.items()) {
    const bool has_own_section = path.empty() && (key == "diagnosis" || key == "uncertainty_budget");
    if (!has_own_section) Enter(path.empty() ? key : path + "." + key, value, look);
  }
}

}  // namespace

void ForEachObject(const nlohmann::json& node, const Look& look) {
  Enter("", node, look);
}

}  // namespace twinbench::report
