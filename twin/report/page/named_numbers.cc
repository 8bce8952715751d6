#include "twin/report/page/named_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>

namespace twinbench::report {
namespace {

/// Longer ones first: "um_m_K" ends in "K" too.
struct WrittenUnit {
  std::string_view in_key, spoken;
};
constexpr auto kUnits = std::to_array<WrittenUnit>({{"um_m_K", "um/m/K"}, {"um_m", "um/m"},   {"um_K", "um/K"}, {"mm_min", "mm/min"},
                                                    {"deg_s", "deg/s"},   {"per_mm2", "mm-2"}, {"arcsec", "arcsec"}, {"mrad", "mrad"},
                                                    {"degC", "degC"},     {"deg", "deg"},     {"rad", "rad"},   {"um", "um"},
                                                    {"nm", "nm"},         {"mm", "mm"},       {"pm", "pm"},     {"px", "px"},
                                                    {"mV", "mV"},         {"ns", "ns"},       {"ms", "ms"},     {"V", "V"},
                                                    {"s", "s"},           {"m", "m"}});
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

NamedUnit NameAndUnit(const std::string& path) {
  const std::string key = WithoutBrackets(path);
  for (const WrittenUnit& unit : kUnits) {
    const std::string ending = "_" + std::string(unit.in_key);
    if (key.size() > ending.size() && key.ends_with(ending))
      return {Spaced(key.substr(0, key.size() - ending.size())), std::string(unit.spoken)};
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

double NumberAt(const nlohmann::json& object, const std::string& key) {
  return object.is_object() && object.contains(key) && object.at(key).is_number()
             ? object.at(key).get<double>()
             : std::numeric_limits<double>::quiet_NaN();
}

std::string TextAt(const nlohmann::json& object, const std::string& key) {
  return object.is_object() && object.contains(key) && object.at(key).is_string() ? object.at(key).get<std::string>() : "";
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
