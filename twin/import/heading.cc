#include "twin/import/heading.h"

#include <algorithm>
#include <string>

#include "twin/import/common.h"
#include "twin/import/layout.h"
#include "twin/import/table.h"
#include "twin/import/text.h"

namespace twinbench::imports {
namespace {

bool AllUnits(const std::vector<std::string_view>& fields) {
  return std::ranges::all_of(fields, [](std::string_view field) { return BareUnit(field).has_value(); }) &&
         std::ranges::any_of(
             fields, [](std::string_view field) {
               return UnitNamed(*BareUnit(field)).has_value() || field.starts_with('[') || field.starts_with('(');
             });
}

/// A name comes once, a unit as often as there are quantities of it.
bool Repeats(std::vector<std::string_view> fields) {
  std::ranges::sort(fields);
  return std::ranges::adjacent_find(fields) != fields.end();
}

bool IsAsWide(std::string_view line, std::size_t width, char separator) {
  std::vector<std::string_view> fields;
  Split(WithoutMark(line), separator, fields);
  return fields.size() == width;
}

/// Between blanks a name may have some of its own: "Target (mm)  Error (um)" are two, where more than one stands between them.
void SplitNames(std::string_view line, char separator, std::size_t width, std::vector<std::string_view>& names) {
  Split(line, separator, names);
  if (separator != ' ' || names.size() <= width) return;
  std::vector<std::string_view> wide;
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t end = std::min(line.find("  ", at), line.size());
    if (end > at) wide.push_back(Trimmed(line.substr(at, end - at)));
    at = std::min(line.find_first_not_of(' ', end), line.size());
  }
  if (wide.size() == width) names = std::move(wide);
}

}  // namespace

std::string_view WithoutMark(std::string_view line) {
  line = Trimmed(line);
  const std::size_t first = line.find_first_not_of("#%/ \t");
  return IsComment(line) && first != std::string_view::npos ? line.substr(first) : line;
}

Heading HeadingOf(const std::vector<std::string_view>& fields) {
  Heading heading;
  heading.found = true;
  for (const std::string_view field : fields) heading.columns.push_back(SplitHeader(field));
  return heading;
}

Heading FindHeading(const std::vector<std::string_view>& above, std::size_t width, char separator) {
  std::vector<std::string_view> names;
  std::vector<std::string> units;
  for (std::size_t i = above.size(); i-- > 0 && above.size() - i <= 3;) {
    SplitNames(WithoutMark(above[i]), separator, width, names);
    if (width == 1) names = {WithoutMark(above[i])};
    if (names.size() > 1 && names.back().empty()) names.pop_back();
    if (names.size() != width && !(names.size() + 1 == width || names.size() == width + 1)) continue;
    if (IsComment(above[i]) && SaysPerTurn(SmallLetters(above[i]))) continue;  // how many counts make a turn
    const bool may_be_units = units.empty() && names.size() == width && i > 0;
    if (may_be_units && (AllUnits(names) || (Repeats(names) && IsAsWide(above[i - 1], width, separator)))) {
      units.assign(names.begin(), names.end());
      continue;
    }
    Heading heading = HeadingOf(names);
    for (std::size_t c = 0; c < std::min(units.size(), heading.columns.size()); ++c)
      heading.columns[c].unit = BareUnit(units[c]).value_or(units[c]);
    return heading;
  }
  return {};
}

}  // namespace twinbench::imports
