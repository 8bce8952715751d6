#include "twin/plan/harmonics.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace twinbench::plan {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kAmplitude = "u_amplitude_";
constexpr std::string_view kOfHarmonics = "u_harmonics";

double NumberOrNaN(const Json& number) {
  return number.is_number() ? number.get<double>() : std::nan("");
}

std::string Below(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

/// "u_amplitude_arcsec" of an object that has one; differences are no amplitudes.
std::string AmplitudeKey(const Json& object) {
  for (const auto& [key, value] : object.items()) {
    if (key.starts_with(kAmplitude) && !key.starts_with("u_amplitude_difference")) return key;
  }
  return "";
}

bool IsTerm(const Json& node) {
  return node.is_object() && node.contains("order") && node.at("order").is_number_integer() &&
         !AmplitudeKey(node).empty();
}

/// A list of them; not that of results that were taken back, in which every number is null.
bool HasOrders(const Json& node) {
  if (!node.is_object() || !node.contains("order") || !node.at("order").is_array()) return false;
  return std::ranges::all_of(node.at("order"), [](const Json& order) { return order.is_number_integer(); });
}

bool IsColumns(const Json& node) {
  return HasOrders(node) && !AmplitudeKey(node).empty();
}

HarmonicCertainty OfColumns(std::string name, const Json& orders, const Json& u) {
  HarmonicCertainty curve{std::move(name), orders.get<std::vector<int>>(), {}};
  for (const Json& one : u) curve.u.push_back(NumberOrNaN(one));
  return curve;
}

HarmonicCertainty OfTerms(std::string name, const Json& terms) {
  HarmonicCertainty curve{std::move(name), {}, {}};
  const std::string key = AmplitudeKey(terms.front());
  for (const Json& term : terms) {
    curve.orders.push_back(term.at("order").get<int>());
    curve.u.push_back(NumberOrNaN(term.at(key)));
  }
  return curve;
}

std::string InUnit(const std::string& path, const Json& object) {
  return path + "_" + AmplitudeKey(object).substr(kAmplitude.size());
}

void Collect(const Json& node, const std::string& path, std::vector<HarmonicCertainty>& found) {
  if (node.is_array() && !node.empty() && IsTerm(node.front())) {
    found.push_back(OfTerms(InUnit(path, node.front()), node));
  } else if (node.is_array()) {
    for (std::size_t i = 0; i < node.size(); ++i) Collect(node[i], path + "[" + std::to_string(i) + "]", found);
  } else if (node.is_object()) {
    if (IsColumns(node)) found.push_back(OfColumns(InUnit(path, node), node.at("order"), node.at(AmplitudeKey(node))));
    for (const auto& [key, value] : node.items()) {
      if (key != kOfHarmonics) {
        Collect(value, Below(path, key), found);
        continue;
      }
      if (!HasOrders(value)) continue;
      for (const auto& [component, u] : value.items()) {
        if (component != "order") found.push_back(OfColumns(Below(path, component), value.at("order"), u));
      }
    }
  }
}

}  // namespace

std::vector<HarmonicCertainty> HarmonicsOf(const Json& results) {
  std::vector<HarmonicCertainty> found;
  Collect(results, "", found);
  return found;
}

}  // namespace twinbench::plan
