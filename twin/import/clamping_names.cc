#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "twin/import/clampings.h"
#include "twin/import/common.h"
#include "twin/import/text.h"
#include "twin/import/unit_names.h"

namespace twinbench::imports {
namespace {

constexpr std::string_view kFigures = "0123456789";

bool IsNameLetter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) || static_cast<unsigned char>(c) >= 0x80;
}

/// The last word before a number, whatever stands between its letters: "clamping no. 2", "setup2".
bool SaysClamping(std::string_view before) {
  constexpr std::array kWords = {"clamping", "clamp",    "mounting",  "setup",    "aufspannung",
                                 "montage",  "fijación", "serraggio", "установка"};
  std::string all;
  std::ranges::copy_if(before, std::back_inserter(all), IsNameLetter);
  std::string_view letters = all;
  for (const std::string_view number : {"number", "nr", "no"}) {
    if (letters.ends_with(number)) letters.remove_suffix(number.size());
  }
  return std::ranges::any_of(kWords, [letters](const char* word) { return letters.ends_with(word); });
}

/// "turned by 30", "offset: 30", without a unit.
bool SaysTurned(std::string_view before) {
  constexpr std::array<std::string_view, 8> kWords = {"offset",     "turned",   "turned by",   "rotated",
                                                      "rotated by", "rotation", "verdreht um", "versatz"};
  while (!before.empty() && !IsNameLetter(before.back())) before.remove_suffix(1);
  return std::ranges::any_of(kWords, [before](std::string_view word) { return before.ends_with(word); });
}

/// How long the name of an angle of some size is that a text begins with: "deg", "°", "_deg"; 0: none. "°C" is
/// none.
std::size_t DegreesAhead(std::string_view rest) {
  std::size_t skipped = 0;
  while (skipped < rest.size() && (rest[skipped] == ' ' || rest[skipped] == '_')) ++skipped;
  for (const std::string_view unit : {"degrees", "degree", "grad", "deg", "°", "º"}) {
    if (!rest.substr(skipped).starts_with(unit)) continue;
    const std::size_t end = skipped + unit.size();
    const bool goes_on = end < rest.size() && IsNameLetter(rest[end]);
    if (!goes_on) return end;
  }
  return 0;
}

bool SameOrNone(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

}  // namespace

bool ClampingSaid::operator==(const ClampingSaid& other) const {
  return SameOrNone(number, other.number) && SameOrNone(turned_deg, other.turned_deg);
}

ClampingSaid ClampingIn(std::string_view text) {
  const std::string small = SmallLetters(Trimmed(text));
  const std::string_view all = small;
  ClampingSaid said;
  for (std::size_t at = 0; (at = all.find_first_of(kFigures, at)) != std::string_view::npos;) {
    const std::size_t end = std::min(all.find_first_not_of("0123456789.,", at), all.size());
    std::string_view digits = all.substr(at, end - at);
    while (kFigures.find(digits.back()) == std::string_view::npos) digits.remove_suffix(1);
    const auto number = FieldNumber(digits, digits.find(',') != std::string_view::npos);
    std::string_view before = all.substr(0, at);
    const bool negative = before.ends_with('-') && before.size() > 1 && !IsNameLetter(before[before.size() - 2]);
    const std::size_t unit = DegreesAhead(all.substr(end));
    if (number && unit > 0 && std::isnan(said.turned_deg)) {
      said.turned_deg = negative ? -*number : *number;
      said.ends_in_angle = end + unit == all.size();
    } else if (number && SaysClamping(before) && std::isnan(said.number)) {
      said.number = *number;
    } else if (number && SaysTurned(before) && std::isnan(said.turned_deg)) {
      said.turned_deg = negative ? -*number : *number;
    }
    at = end;
  }
  return said;
}

ClampingSaid ClampingOf(const Column& column) {
  const bool is_in_degrees = UnitNamed(column.unit) && UnitNamed(column.unit)->name == "deg";
  const bool ends_in_number = !column.name.empty() && kFigures.find(column.name.back()) != std::string_view::npos;
  return ClampingIn(is_in_degrees && ends_in_number ? column.name + " deg" : column.name);
}

bool SeeksClampings(const Map& map) {
  return std::ranges::find(map.sought, "offset_deg", &Sought::name) != map.sought.end();
}

void TakeClampingLines(const Map& map, Track& track) {
  if (!SeeksClampings(map) || track.Rows() == 0) return;
  Column number{"clamping", "", std::vector<double>(track.Rows(), kNaN), {}},
      turned{"offset", "deg", std::vector<double>(track.Rows(), kNaN), {}};
  std::size_t places = 0, last_row = track.Rows();
  for (const TextLine& line : track.lines) {
    const ClampingSaid said = ClampingIn(line.text);
    if (!said.Any() || line.row >= track.Rows()) continue;
    places += line.row != last_row ? 1 : 0;
    last_row = line.row;
    const auto from = static_cast<std::ptrdiff_t>(line.row);
    std::fill(number.value.begin() + from, number.value.end(), said.number);
    std::fill(turned.value.begin() + from, turned.value.end(), said.turned_deg);
  }
  const bool divides =
      places > 1 || (places == 1 && std::isnan(number.value.front()) && std::isnan(turned.value.front()));
  if (!divides) return;  // a line above all rows says nothing that differs
  for (Column* column : {&number, &turned}) {
    const bool says = std::ranges::any_of(column->value, [](double x) { return std::isfinite(x); });
    const bool is_there = std::ranges::find(track.columns, column->name, &Column::name) != track.columns.end();
    if (!says || is_there) continue;
    for (double& x : column->value) x = std::isfinite(x) ? x : 0.0;  // rows above the first line: as they were
    track.columns.push_back(*column);
  }
}

}  // namespace twinbench::imports
