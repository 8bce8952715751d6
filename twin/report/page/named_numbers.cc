#include "twin/report/page/named_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>
#include <utility>

#include "twin/core/unit_text.h"
#include "twin/report/sound.h"

namespace twinbench::report {
namespace {

/// Longer ones first: "um_m_K" ends in "K" too.
constexpr auto kUnits = std::to_array<std::string_view>({"um_m_K", "um_m", "um_K", "mm_min", "deg_s", "per_mm2", "arcsec", "mrad", "degC", "deg", "rad", "um",
                                                         "nm", "mm", "pm", "px", "mV", "ns", "ms", "V", "s", "m"});
/// What the field calls the parts of a bench and the errors of an axis of rotation (ISO 230-7).
constexpr auto kNames = std::to_array<std::pair<std::string_view, std::string_view>>(
    {{"target", "table under test"}, {"reference", "reference table"}, {"multitooth", "multi-tooth table"}, {"device", "device under test"},
     {"ez", "index error EZ"}, {"ex", "tilt error EX"}, {"ey", "tilt error EY"}, {"dx", "radial error DX"}, {"dy", "radial error DY"},
     {"dz", "axial error DZ"}, {"setups", "mountings"}, {"iso230", "ISO 230, part"}, {"vdi3441", "VDI/DGQ 3441"}});
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
  for (const std::string_view unit : kUnits) {
    const std::string ending = "_" + std::string(unit);
    if (key.size() > ending.size() && key.ends_with(ending))
      return {Spaced(key.substr(0, key.size() - ending.size())), UnitInPrint(unit)};
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

std::string CurveTitle(const std::string& path, const std::string& name) {
  std::string title, word;
  std::istringstream words(PathInWords(path) + (name.empty() ? "" : " : " + name));
  while (words >> word) {
    if (word == ":") {
      title += ":";
      continue;
    }
    for (const auto& [key, spoken] : kNames)
      if (word == key) word = spoken;
    title += (title.empty() ? "" : " ") + word;
  }
  if (!title.empty()) title.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(title.front())));
  return title;
}

std::string UnitText(const std::string& unit) {
  return InPrint(UnitInPrint(unit));  // "per_m2", and "um/m"
}

std::string ShownUnit(const std::string& unit) {
  return unit == "deg" ? "°" : UnitText(unit);
}

std::string AfterNumber(const std::string& shown_unit) {
  return shown_unit.empty() || shown_unit == "°" ? shown_unit : " " + shown_unit;
}

std::string NumberText(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : "";
}

std::string NumberText(double value, double u) {
  if (!std::isfinite(value)) return "";
  if (!std::isfinite(u) || u <= 0.0) return NumberText(value);
  const int digits = 1 - static_cast<int>(std::floor(std::log10(u)));
  if (digits > 12) return NumberText(value);
  const double tens = std::pow(10.0, std::max(0, -digits));
  if (digits < 0) return fmt::format("{:.0f}", std::round(value / tens) * tens);
  return fmt::format("{:.{}f}", value, digits);
}

std::string MeasuredText(double value, double u, const std::string& unit) {
  const int power = std::abs(value) >= 1e6 ? static_cast<int>(std::floor(std::log10(std::abs(value)))) : 0;
  const double one = std::pow(10.0, power);
  std::string text = NumberText(value / one, u / one);
  if (text.starts_with('-')) text.replace(0, 1, "−");
  if (u > 0.0) text += " ± " + NumberText(u / one, u / one);
  if (power > 0) text = fmt::format("({})e{}", text, power);
  return text + AfterNumber(ShownUnit(unit));
}

}  // namespace twinbench::report
