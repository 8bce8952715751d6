#include "twin/campaign/stated_results.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "twin/core/reading.h"

namespace twinbench::campaign {
namespace {

using nlohmann::json;

bool IsNumberOrNull(const json& node) {
  return node.is_number() || node.is_null();
}

double NumberOf(const json& node) {
  return node.is_number() ? node.get<double>() : kNaN;
}

std::string Below(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

/// "value" and "value_um" say only what the path already says, but for the unit.
std::string NameOf(const std::string& path, const std::string& key) {
  constexpr std::string_view kValue = "value";
  if (!key.starts_with(kValue) || path.empty()) return Below(path, key);
  return path + key.substr(kValue.size());
}

/// The key of the uncertainty of `key`: u, u_um, u_ez_arcsec.
std::string UncertaintyKey(const json& table, const std::string& key) {
  if (key == "value") return "u";
  if (key.starts_with("value_") && table.contains("u_" + key.substr(6))) return "u_" + key.substr(6);
  return "u_" + key;
}

void Keep(const std::string& name, const json& value, const json& u, std::vector<TrialResult>& kept) {
  if (IsNumberOrNull(value) && IsNumberOrNull(u)) {
    kept.push_back({name, NumberOf(value), NumberOf(u), kNaN});
  } else if (value.is_array() && u.is_array() && value.size() == u.size()) {
    for (std::size_t i = 0; i < value.size(); ++i) Keep(fmt::format("{}[{}]", name, i), value[i], u[i], kept);
  }
}

void Collect(const std::string& path, const json& node, std::vector<TrialResult>& kept) {
  if (node.is_array()) {
    for (std::size_t i = 0; i < node.size(); ++i) Collect(fmt::format("{}[{}]", path, i), node[i], kept);
  }
  if (!node.is_object()) return;
  for (const auto& [key, value] : node.items()) {
    const auto u = node.find(UncertaintyKey(node, key));
    if (u != node.end()) Keep(NameOf(path, key), value, *u, kept);
    Collect(Below(path, key), value, kept);
  }
}

}  // namespace

std::vector<TrialResult> StatedResults(const json& results) {
  std::vector<TrialResult> kept;
  Collect("", results, kept);
  return kept;
}

}  // namespace twinbench::campaign
