#include "twin/import/layout.h"

#include <algorithm>
#include <cctype>
#include <functional>
#include <map>

#include "twin/import/clock.h"
#include "twin/import/layouts.h"

namespace twinbench::imports {
namespace {

bool LooksLikeDate(std::string_view field) {
  return field.size() >= 8 && std::isdigit(static_cast<unsigned char>(field.front())) &&
         ParseInstant(field).has_value();
}

/// Name, date, time of day, value: what `camonitor` writes.
bool IsChange(std::string_view line) {
  std::vector<std::string_view> fields;
  Split(line, ' ', fields);
  if (fields.size() < 4 || FieldNumber(fields[0], false)) return false;
  const std::string_view date = fields[1].starts_with('(') ? fields[1].substr(1) : fields[1];
  return LooksLikeDate(date) && fields[2].find(':') != std::string_view::npos;
}

bool Has(const std::vector<std::string_view>& lines, std::string_view what) {
  return std::ranges::any_of(lines,
                             [what](std::string_view line) { return line.find(what) != std::string_view::npos; });
}

/// `name[...] = {`, or the brace on the next line.
bool OpensArray(std::string_view line) {
  const std::string_view declared = Trimmed(line.substr(0, line.find('{')));
  const std::size_t bracket = declared.find('['), close = declared.rfind(']');
  const bool is_array = bracket != std::string_view::npos && close != std::string_view::npos && bracket < close;
  return is_array && (declared.size() < Trimmed(line).size() ? declared.find('=', bracket) != std::string_view::npos : declared.ends_with('=') && declared.find(',') == std::string_view::npos);
}

bool IsOneLine(const std::vector<std::string_view>& lines) {
  return std::ranges::count_if(lines, std::not_fn(IsComment)) == 1;
}

/// A scope's export pairs each key with a value, and its first channel's row begins a line.
bool IsScope(const std::vector<std::string_view>& lines) {
  return Has(lines, "Starttime of export") || (Has(lines, "SampleTime[ms]") && Has(lines, "Data-Type"));
}

/// How much of the lines is rows of numbers.
double Score(const std::vector<std::string_view>& lines, const Fields& how) {
  std::map<std::size_t, double> score;  // by number of fields
  std::vector<std::string_view> fields;
  for (const std::string_view line : lines) {
    if (IsComment(line)) continue;
    Split(line, how.separator, fields);
    if (fields.size() < 2) continue;
    const auto good = std::ranges::count_if(fields, [&how](std::string_view field) {
      return field.empty() || CellOf(field, how.decimal_comma) || LooksLikeDate(field);
    });
    const double share = static_cast<double>(good) / static_cast<double>(fields.size());
    if (share >= 0.4) score[fields.size()] += share * share * share;
  }
  double best = 0.0;
  for (const auto& [count, sum] : score) best = std::max(best, sum);
  return best;
}

}  // namespace

Layout WithTabs(Layout layout) {
  layout.separator = "tab";
  layout.decimal = "point";
  return layout;
}

std::vector<std::string_view> FirstLines(std::string_view text, std::size_t most) {
  std::vector<std::string_view> first;
  Lines lines(text);
  for (std::string_view line; first.size() < most && lines.Next(line);) {
    if (!Trimmed(line).empty()) first.push_back(line);
  }
  return first;
}

bool IsComment(std::string_view line) {
  line = Trimmed(line);
  return line.empty() || line.front() == '#' || line.front() == '%' || line.starts_with("//");
}

bool IsRule(std::string_view line) {
  return !Trimmed(line).empty() && line.find_first_not_of("-| \t:=+") == std::string_view::npos;
}

std::string FindKind(const std::vector<std::string_view>& lines, bool columns_are_open) {
  if (OpensRecords(lines)) return "records";
  if (IsScope(lines)) return "scope";
  const auto changes = std::ranges::count_if(lines, IsChange);
  if (2 * changes > std::ssize(lines)) return "changes";
  if (Has(lines, "ref_pos(i,")) return "cycles";
  if (std::ranges::any_of(lines, OpensArray)) return "array";
  if (std::ranges::count_if(lines, OpensList) > 1 || (IsBareList(lines) && (columns_are_open || IsOneLine(lines)))) return "array";
  if (columns_are_open && AreCycles(lines)) return "cycles";
  return "table";
}

Fields FindFields(const std::vector<std::string_view>& lines, const Layout& layout) {
  Fields best{'\0', layout.decimal == "comma"};
  double best_score = 0.0;
  for (const char separator : {'\t', ';', ',', '|', ' '}) {
    if (layout.separator != "auto" && SeparatorNamed(layout.separator) != separator) continue;
    for (const bool comma : {false, true}) {
      if ((layout.decimal != "auto" && (layout.decimal == "comma") != comma) || (comma && separator == ','))
        continue;
      const Fields how{separator, comma};
      const double score = Score(lines, how);
      if (score <= 1.001 * best_score) continue;
      best_score = score;
      best = how;
    }
  }
  return best;
}

}  // namespace twinbench::imports
