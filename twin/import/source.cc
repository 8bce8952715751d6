#include "twin/import/source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/import/column_words.h"
#include "twin/import/common.h"
#include "twin/import/layouts.h"
#include "twin/import/text.h"

namespace twinbench::imports {
namespace {

constexpr std::size_t kMostColumns = 40;  // of a file that is still looked at

std::string ColumnText(const Column& column) {
  const std::string unit = column.unit.empty() ? "" : " [" + column.unit + "]";
  if (!column.IsNumber()) {
    std::string words;
    for (std::size_t i = 0; i < std::min<std::size_t>(4, column.words.size()); ++i)
      words += fmt::format("{}\"{}\"", i == 0 ? "" : ", ", column.words[i]);
    return fmt::format("    {}{}: words: {}{}\n", column.name, unit, words, column.words.size() > 4 ? ", ..." : "");
  }
  double low = INFINITY, high = -INFINITY;
  std::size_t none = 0;
  for (const double x : column.value) {
    if (!std::isfinite(x)) {
      ++none;
      continue;
    }
    low = std::min(low, x);
    high = std::max(high, x);
  }
  if (low > high) return fmt::format("    {}{}: no numbers\n", column.name, unit);
  const std::string missing = none > 0 ? fmt::format(", {} rows without", none) : "";
  if (low == high) return fmt::format("    {}{}: always {:.10g}{}\n", column.name, unit, low, missing);
  return fmt::format("    {}{}: {:.10g} to {:.10g}{}\n", column.name, unit, low, high, missing);
}

std::string Describe(const Track& track) {
  std::string text = fmt::format("  {}: {} rows; {}\n", track.name, track.Rows(), ClockText(track));
  for (std::size_t c = 0; c < std::min(kMostColumns, track.columns.size()); ++c)
    text += ColumnText(track.columns[c]);
  if (track.columns.size() > kMostColumns)
    text += fmt::format("    and {} more\n", track.columns.size() - kMostColumns);
  std::string numbers;
  for (const auto& [name, number] : track.numbers) {
    if (numbers.size() < 300) numbers += fmt::format("{}{} = {:g}", numbers.empty() ? "" : ", ", name, number);
  }
  return numbers.empty() ? text : text + "    numbers above the rows: " + numbers + "\n";
}

/// "up" and "down" in a column called direction are 1 and -1; of ways round, "cw" or "G02", no name need say so.
void WordsToDirections(Column& column) {
  const bool is_called = IsCalledDirection(column.name);
  const bool all = !column.IsNumber() && std::ranges::all_of(column.words, [is_called](const std::string& word) {
    return (is_called ? DirectionOfWord(word) : TurnIn(word)) != 0;
  });
  if (!all) return;
  if (!is_called) column.name = "direction, " + column.name;
  for (double& x : column.value) {
    if (std::isfinite(x)) x = DirectionOfWord(column.words[static_cast<std::size_t>(x)]);
  }
  column.words.clear();
}

}  // namespace

Recording ReadRecording(const std::string& path, const Layout& layout, const ClockSettings& clock) {
  Recording recording;
  recording.file = path;
  const std::string text = LoadText(path);
  if (IsBarExport(FirstLines(text))) {
    ReadTable(TableOfBarExport(text, path, recording.remarks), {}, clock, recording);
    recording.layout = "tags and runs of a ball bar";
    return recording;
  }
  if (AreLaserRuns(FirstLines(text))) {
    ReadCycles(TableOfLaserRuns(text, recording.remarks), WithTabs({}), recording);
    return recording;
  }
  if ((layout.columns_are_open || layout.kind == "cycles") && AreIndexed(FirstLines(text))) {
    if (const std::string table = TableOfIndexed(text); !table.empty()) {
      ReadCycles(table, {}, recording);
      return recording;
    }
  }
  const bool are_lists = layout.kind == "auto" && AreNamedLists(FirstLines(text));
  const std::string kind = layout.kind == "auto" ? FindKind(FirstLines(text), layout.columns_are_open) : layout.kind;
  if (are_lists) {
    ReadTable(TableOfNamedLists(text), WithTabs(layout), clock, recording);
    recording.layout = "records of lists under names";
    recording.usual_angle = "rad";  // what programs count in
  } else if (kind == "changes") {
    ReadChanges(text, recording);
  } else if (kind == "scope") {
    ReadScope(text, recording);
  } else if (kind == "array") {
    ReadArray(text, layout.array, recording);
    for (Track& track : recording.tracks) FindClock(clock, path, track);
  } else if (kind == "cycles") {
    ReadCycles(text, layout, recording);
  } else if (kind == "records") {
    ReadRecords(text, layout, clock, recording);
  } else if (layout.separator == "auto" && AreSentences(FirstLines(text))) {
    ReadTable(TableOfSentences(text), WithTabs(layout), clock, recording);
    recording.layout = "lines of names and values";
  } else {
    ReadTable(text, layout, clock, recording);
  }
  for (Track& track : recording.tracks) {
    for (Column& column : track.columns) WordsToDirections(column);
  }
  return recording;
}

Recording BeginOfTable(const std::string& path, const ClockSettings& clock) {
  Recording recording;
  recording.file = path;
  std::string text = LoadText(path);
  if (std::vector<std::string> said; IsBarExport(FirstLines(text))) text = TableOfBarExport(text, path, said);
  const std::vector<std::string_view> lines = FirstLines(text);
  const std::string kind = FindKind(lines, true);
  if (AreNamedLists(lines) || AreLaserRuns(lines)) return recording;
  if (kind == "array") return recording;  // a line of thousands of numbers is no row of as many columns
  constexpr std::size_t kBegin = 5000;  // lines: an axis may rest for a while before it moves
  std::string begin;
  for (const std::string_view line : FirstLines(text, kBegin)) begin += std::string(line) + "\n";
  try {
    if (kind == "records")
      ReadRecords(text, {}, clock, recording);
    else if (AreSentences(lines))
      ReadTable(TableOfSentences(begin), WithTabs({}), clock, recording);
    else
      ReadTable(begin, {}, clock, recording);
  } catch (const InputError&) {
    recording.tracks.clear();
  }
  for (Track& track : recording.tracks) {
    for (Column& column : track.columns) WordsToDirections(column);
  }
  return recording;
}

std::string ClockText(const Track& track) {
  if (!track.HasClock()) return "no clock: rows in order";
  const std::vector<double> steps = StepsOf(track.time_s);
  const double usual_s = MedianOf(steps);
  std::string text = fmt::format("clock: {}", track.clock);
  if (usual_s > 0.0) text += fmt::format(", {:.6g} s between rows ({:.4g} Hz)", usual_s, 1.0 / usual_s);
  const auto gaps = std::ranges::count_if(steps, [usual_s](double step) { return step > kGapIntervals * usual_s; });
  if (gaps > 0) {
    text += fmt::format(", {} gaps of more than {:.3g} s, the longest {:.4g} s", gaps, kGapIntervals * usual_s,
                        *std::ranges::max_element(steps));
  }
  const auto back = std::ranges::count_if(steps, [](double step) { return step < 0.0; });
  if (back > 0) text += fmt::format(", {} times it goes back", back);
  return text;
}

std::string Describe(const Recording& recording) {
  std::string text = fmt::format("{}: {}\n", recording.file, recording.layout);
  for (const Track& track : recording.tracks) text += Describe(track);
  return text;
}

std::string RemarksOn(const Recording& recording) {
  std::string text;
  for (const LeftOut& left_out : recording.left_out)
    text += fmt::format("left out: {} {}\n", left_out.count, left_out.why);
  for (const std::string& remark : recording.remarks) text += "note: " + remark + "\n";
  return text;
}

}  // namespace twinbench::imports
