#include "twin/report/page/named_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace twinbench::report {
namespace {

/// Longer ones first: "um_m_K" ends in "K" too.
constexpr std::array kUnits = {"um_m_K", "um_m",  "um_K", "mm_min", "deg_s", "per_mm2", "arcsec", "mrad", "degC",
                               "deg",    "rad",   "um",   "nm",     "mm",    "pm",      "px",     "mV",   "ns",
                               "ms",     "minutes", "V",  "s",      "m"};
constexpr std::array kPlaces = {"separation.", "results.", "values."};

/// "terms[]" are the terms.
std::string WithoutBrackets(std::string path) {
  for (std::size_t at = path.find("[]"); at != std::string::npos; at = path.find("[]")) path.erase(at, 2);
  return path;
}

std::string Spaced(std::string text) {
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

}  // namespace

NamedUnit NameAndUnit(const std::string& key) {
  for (const std::string unit : kUnits) {
    const std::string ending = "_" + unit;
    if (key.size() > ending.size() && key.ends_with(ending))
      return {Spaced(key.substr(0, key.size() - ending.size())), unit};
  }
  return {Spaced(key), ""};
}

std::optional<std::vector<double>> NumbersOf(const nlohmann::json& node) {
  if (!node.is_array() || node.empty()) return {};
  std::vector<double> numbers;
  numbers.reserve(node.size());
  for (const nlohmann::json& value : node) {
    if (!value.is_number() && !value.is_null()) return {};
    numbers.push_back(value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>());
  }
  return numbers;
}

std::optional<std::vector<double>> NumbersAt(const nlohmann::json& object, const std::string& key) {
  return object.is_object() && object.contains(key) ? NumbersOf(object.at(key)) : std::nullopt;
}

std::string PathInWords(const std::string& path) {
  std::string words = WithoutBrackets(path);
  for (const std::string place : kPlaces) {
    if (words.starts_with(place)) words = words.substr(place.size());
  }
  std::replace(words.begin(), words.end(), '.', ' ');
  return Spaced(words);
}

std::string NumberText(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : "";
}

std::string NumberText(double value, double u) {
  if (!std::isfinite(value)) return "";
  if (!std::isfinite(u) || u <= 0.0) return NumberText(value);
  const int digits = 1 - static_cast<int>(std::floor(std::log10(u)));
  if (digits < 0 || digits > 12) return fmt::format("{:.6g}", value);
  return fmt::format("{:.{}f}", value, digits);
}

}  // namespace twinbench::report
