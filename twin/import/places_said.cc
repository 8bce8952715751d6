#include "twin/import/places_said.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>

#include "twin/core/errors.h"
#include "twin/import/column_words.h"
#include "twin/import/common.h"
#include "twin/import/text.h"
#include "twin/import/unit_names.h"

namespace twinbench::imports {
namespace {

constexpr std::string_view kDigitsOfAngle = "0123456789.";

struct ProbeSaid {
  Column* column = nullptr;
  double angle_deg = 0.0;
  bool in_degrees = false;  // else it may be its number
};

/// A probe's name, and behind it a number and nothing but units.
std::optional<ProbeSaid> ProbeIn(Column& column) {
  constexpr std::array kCalled = {"probe", "sensor", "taster", "s", "p", "sonde", "capteur", "gauge", "sonda", "sensore"};
  const std::string small = SmallLetters(column.name);
  const std::size_t at = small.find_first_of(kDigitsOfAngle), end = std::min(small.find_first_not_of(kDigitsOfAngle, at), small.size());
  if (at == std::string::npos) return std::nullopt;
  const std::string_view word = std::string_view(small).substr(0, small.find_last_not_of(" _-.@#", at - 1) + 1);
  const auto number = FieldNumber(std::string_view(small).substr(at, end - at), false);
  if (at == 0 || !number || std::ranges::find(kCalled, word) == kCalled.end()) return std::nullopt;
  std::string_view behind = std::string_view(small).substr(end);
  while (!behind.empty() && (behind.front() == ' ' || behind.front() == '_')) behind.remove_prefix(1);
  const auto unit = UnitNamed(behind);
  if (!behind.empty() && !unit) return std::nullopt;
  const auto is_deg = [](const std::optional<NamedUnit>& u) { return u && u->name == "deg"; };
  return ProbeSaid{&column, *number, is_deg(unit) || is_deg(UnitNamed(column.unit))};
}

/// "probe angles [deg]: 0; 100; 213".
std::vector<double> AnglesIn(const std::string& line) {
  const bool speaks = ClearnessBy(line, {"angles", "positions", "winkel"}) > 0 && ClearnessBy(line, {"probe", "probes", "sensor", "sensors", "taster"}) > 0;
  const std::size_t begin = line.find_first_of(":=");
  std::vector<double> angles;
  for (std::size_t at = begin; speaks && (at = line.find_first_of(kDigitsOfAngle, at)) < line.size();) {
    const std::size_t end = std::min(line.find_first_not_of(kDigitsOfAngle, at), line.size());
    if (const auto number = FieldNumber(std::string_view(line).substr(at, end - at), false)) angles.push_back(*number);
    at = end;
  }
  return angles;
}

/// Two of x, y, z behind the word, whatever stands between them: "plane: Y-Z"; or the code of the plane.
std::string PlaneIn(const std::string& text, bool is_plane) {
  constexpr std::array kCodes = {std::pair{"g17", "XY"}, std::pair{"g18", "ZX"}, std::pair{"g19", "YZ"}};
  const std::string small = SmallLetters(text);
  for (const auto& [code, plane] : kCodes)
    if (small.find(code) != std::string::npos) return plane;
  std::size_t at = is_plane ? 0 : std::string::npos;
  for (const std::string word : {"plane", "ebene", "plano", "piano"})
    if (at == std::string::npos && small.find(word) != std::string::npos) at = small.find(word) + word.size();
  std::string axes;
  for (; at < small.size() && axes.size() < 3; ++at)
    if (std::isalpha(static_cast<unsigned char>(small[at]))) axes += static_cast<char>(std::toupper(small[at]));
  const auto is_axis = [](char c) { return c >= 'X' && c <= 'Z'; };
  const bool are_two = axes.size() > 1 && is_axis(axes[0]) && is_axis(axes[1]) && axes[0] != axes[1];
  return are_two && (axes.size() == 2 || !is_axis(axes[2])) ? axes.substr(0, 2) : "";
}

std::string AxisIn(const std::string& name) {
  for (const char* axis : {"x", "y", "z"})
    if (ClearnessBy(name, {axis}) > 0) return std::string(1, static_cast<char>(std::toupper(*axis)));
  return "";
}

}  // namespace

std::vector<double> TakeAnglesOfProbes(Track& track) {
  constexpr double kMoreThanProbes = 12.0;
  std::vector<ProbeSaid> probes;
  for (Column& column : track.columns)
    if (const auto probe = column.IsNumber() ? ProbeIn(column) : std::nullopt) probes.push_back(*probe);
  std::ranges::stable_sort(probes, {}, &ProbeSaid::angle_deg);
  const bool are_angles = std::ranges::any_of(probes, [](const ProbeSaid& p) { return p.in_degrees || p.angle_deg > kMoreThanProbes; });
  std::vector<double> angles;
  for (std::size_t k = 0; are_angles && k < probes.size(); ++k) {
    probes[k].column->name = fmt::format("probe {}", k + 1);
    if (UnitNamed(probes[k].column->unit).value_or(NamedUnit{}).name == "deg") probes[k].column->unit = "";
    angles.push_back(probes[k].angle_deg);
  }
  for (const TextLine& line : track.lines)
    if (angles.size() < 2) angles = AnglesIn(line.text);
  return angles.size() < 2 ? std::vector<double>() : angles;
}

std::optional<std::string> PlaneOf(const Track& track, const std::string& first, const std::string& second, const std::string& file) {
  std::set<std::string> planes;
  for (const TextLine& line : track.lines) planes.insert(PlaneIn(line.text, false));
  for (const Column& column : track.columns) {
    const bool is_plane = ClearnessBy(column.name, {"plane", "ebene", "plan", "plano", "piano"}) > 0;
    for (const std::string& word : column.words) planes.insert(PlaneIn(word, is_plane));
  }
  planes.erase("");
  if (planes.empty() && !AxisIn(first).empty() && !AxisIn(second).empty()) planes.insert(AxisIn(first) + AxisIn(second));
  if (planes.size() > 1)
    throw InputError(file, fmt::format("circles in the planes {} are in one file", fmt::join(planes, ", ")), "a file for each plane: each has errors of its own");
  return planes.empty() ? std::nullopt : std::optional(*planes.begin());
}

}  // namespace twinbench::imports
