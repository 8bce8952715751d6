#include "twin/report/page/modest_json.h"

#include <nlohmann/json.hpp>

#include "twin/core/errors.h"

namespace twinbench::report {

nlohmann::json ParseModestJson(const std::string& text, const std::string& name) {
  const auto keep = [&](int depth, nlohmann::json::parse_event_t, nlohmann::json&) {
    if (depth <= kDeepestJson) return true;
    throw InputError(name, "lists and objects in it are nested more than " + std::to_string(kDeepestJson) + " deep", "JSON as twinbench writes it");
  };
  try {
    return nlohmann::json::parse(text, keep);
  } catch (const nlohmann::json::exception& error) {
    throw InputError(name, error.what(), "JSON as twinbench writes it");
  }
}

}  // namespace twinbench::report
