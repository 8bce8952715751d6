#include "twin/import/axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>

#include "twin/core/errors.h"
#include "twin/import/choices.h"
#include "twin/import/column_words.h"

namespace twinbench::imports {
namespace {

std::string ListOf(const std::vector<std::string>& axes) {
  std::string list;
  for (std::size_t k = 0; k < axes.size(); ++k) list += fmt::format("{}{}: {}", k == 0 ? "" : ", ", k + 1, axes[k]);
  return list;
}

// Rows of several axes below each other.

/// A column that says whose row it is: a few values, each of them again and again.
bool SaysWhoseRow(const Column& column) {
  constexpr std::size_t kFewestRows = 8;
  static const std::set<std::string> kCalled = {"axis", "joint", "servo", "motor", "actuator", "achse", "gelenk", "eje", "axe", "asse", "eixo",
                                                "axis id", "joint id", "servo id", "motor id", "axis name", "joint name", "axis index", "joint index"};
  if (!kCalled.contains(BareName(column.name))) return false;
  std::map<double, std::size_t> rows;
  for (const double value : column.value) {
    if (!std::isfinite(value) || value != std::round(value)) return false;
    ++rows[value];
  }
  return rows.size() > 1 && std::ranges::all_of(rows, [](const auto& of) { return of.second >= kFewestRows; });
}

void KeepRows(const std::vector<std::size_t>& rows, Track& track) {
  const auto keep = [&rows](std::vector<double>& values) {
    std::vector<double> kept;
    for (const std::size_t row : rows) kept.push_back(values[row]);
    values = std::move(kept);
  };
  for (Column& column : track.columns) keep(column.value);
  keep(track.time_s);
  track.lines.clear();
}

/// Where the rows are of several axes.
void TakeRowsOfAxis(Map& map, Recording& recording, Track& track) {
  const auto whose = std::ranges::find_if(track.columns, SaysWhoseRow);
  if (whose == track.columns.end()) return;
  const Column label = *whose;
  const std::set<double> values(label.value.begin(), label.value.end());
  std::vector<std::string> axes;
  for (const double value : values)
    axes.push_back(label.IsNumber() ? fmt::format("{} {:g}", label.name, value) : label.words[static_cast<std::size_t>(value)]);
  const double chosen = *std::next(values.begin(), static_cast<std::ptrdiff_t>(ChosenOf(axes, map, recording.remarks)));
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < label.value.size(); ++i)
    if (label.value[i] == chosen) rows.push_back(i);
  recording.left_out.push_back({label.value.size() - rows.size(), "rows of other axes"});
  KeepRows(rows, track);
  std::erase_if(track.columns, [&label](const Column& column) { return column.name == label.name; });
}

// Columns of several axes side by side.

/// What is left of a name without what says that it is a command, a place, or a joint: the axis.
std::string AxisOf(const std::string& name) {
  std::string axis, word;
  const auto end_word = [&] {
    if (!word.empty() && !SpeaksOfSide(word)) axis += SmallLetters(word) + " ";
    word.clear();
  };
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    const bool is_letter = std::isalpha(c) || c >= 0x80, is_digit = std::isdigit(c);
    const bool continues = !word.empty() && ((is_digit && std::isdigit(static_cast<unsigned char>(word.back()))) ||
                                             (is_letter && !std::isdigit(static_cast<unsigned char>(word.back())) &&
                                              !(std::isupper(c) && std::islower(static_cast<unsigned char>(word.back())))));
    if (!continues) end_word();
    if (is_letter || is_digit) word += name[i];
  }
  end_word();
  return axis;
}

/// Of each axis the clearest command and the clearest place beside it, in the order of the file.
std::vector<AxisPair> PairsIn(const std::vector<Choice>& columns) {
  std::vector<std::string> order;
  std::map<std::string, AxisPair> of_axis;
  const auto is_clearer = [](const Choice& choice, const Choice* than, Speaks of) {
    const auto clearness = [of](const Choice& c) { return 2 * Clearness(c.name, of) + (IsCalledPlace(c.name) ? 1 : 0); };
    return !than || clearness(choice) > clearness(*than);
  };
  for (const Choice& choice : columns) {
    const bool is_command = IsCalledCommand(choice.name);  // which may be for one place
    if ((!is_command && !Changes(choice)) || IsOtherQuantity(*choice.column) || IsCalledError(choice.name)) continue;
    const std::string axis = AxisOf(choice.name);
    if (axis.empty()) continue;
    if (!of_axis.contains(axis)) order.push_back(axis);
    AxisPair& pair = of_axis[axis];
    if (is_command && is_clearer(choice, pair.reference, Speaks::kReference)) pair.reference = &choice;
    if (!is_command && (Clearness(choice.name, Speaks::kDevice) > 0 || IsCalledPlace(choice.name)) && is_clearer(choice, pair.shown, Speaks::kDevice))
      pair.shown = &choice;
  }
  std::vector<AxisPair> pairs;
  for (const std::string& axis : order) {
    if (of_axis[axis].reference && of_axis[axis].shown) pairs.push_back(of_axis[axis]);
  }
  return pairs;
}

/// Where there are columns of several axes.
void TakePair(Map& map, std::vector<Recording>& recordings) {
  const std::vector<Choice> columns = NumberColumns(recordings);
  const std::vector<AxisPair> pairs = PairsIn(columns);
  if (pairs.size() > 1) TakeOneOf(pairs, {"reference_deg", "measured_deg"}, map, recordings.front().remarks);
}

}  // namespace

bool MayBeOneAxis(const AxisPair& pair) {
  const std::string &a = pair.reference->name, &b = pair.shown->name;
  return pair.has_difference || (SaysNothing(a) && SaysNothing(b)) || AxisOf(a) == AxisOf(b);
}

std::size_t ChosenOf(const std::vector<std::string>& axes, Map& map, std::vector<std::string>& remarks) {
  const auto number = static_cast<std::size_t>(std::max(1, map.course.axis_number));
  if (number > axes.size())
    throw InputError("--axis-number", fmt::format("axis {} of {} axes ({})", number, axes.size(), ListOf(axes)), fmt::format("1 to {}", axes.size()));
  remarks.push_back(fmt::format("{} axes are in the file ({}): {} is taken; another one by --axis-number N, or --column", axes.size(), ListOf(axes), number));
  map.course.axis_number = 0;
  return number - 1;
}

void TakeOneOf(const std::vector<AxisPair>& pairs, const std::vector<std::string>& compared, Map& map, std::vector<std::string>& remarks) {
  std::vector<std::string> axes;
  for (const AxisPair& pair : pairs) axes.push_back(fmt::format("\"{}\" against \"{}\"", pair.shown->name, pair.reference->name));
  const AxisPair& chosen = pairs[pairs.size() == 1 ? 0 : ChosenOf(axes, map, remarks)];
  Put(compared[0], *chosen.reference, chosen.why_reference, map, remarks);
  Put(compared[1], *chosen.shown, chosen.why_shown, map, remarks);
}

void RequireAxisWasThere(const Map& map) {
  if (map.course.axis_number > 1)
    throw InputError("--axis-number", fmt::format("axis {}, and of no several axes is a command beside a place known", map.course.axis_number),
                     "a file of several axes, or the columns by --column");
}

void TakeAxis(Map& map, std::vector<Recording>& recordings) {
  const bool is_open = map.columns.empty() && map.bench.empty() && map.sought.empty();
  if (recordings.size() != 1 || recordings.front().tracks.size() != 1) return;
  TakeRowsOfAxis(map, recordings.front(), recordings.front().tracks.front());
  if (is_open) TakePair(map, recordings);
}

}  // namespace twinbench::imports
