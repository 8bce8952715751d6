#include "twin/import/side_by_side.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>

#include "twin/import/axes.h"
#include "twin/import/choices.h"
#include "twin/import/column_words.h"

namespace twinbench::imports {
namespace {

bool MayBeSides(const std::vector<Recording>& recordings) {
  const auto is_one_table = [](const Recording& r) { return r.tracks.size() == 1 && !r.parts_are_setups; };
  if (recordings.size() != 2 || !std::ranges::all_of(recordings, is_one_table)) return false;
  const Track &a = recordings[0].tracks[0], &b = recordings[1].tracks[0];
  return a.Rows() == b.Rows() && std::ranges::equal(a.columns, b.columns, {}, &Column::name, &Column::name);
}

/// "[2:angle]", "1:angle - 3".
bool SpeaksOfFiles(const Map& map) {
  return std::ranges::any_of(map.columns, [](const MappedColumn& c) {
    return c.expression.find("1:") != std::string::npos || c.expression.find("2:") != std::string::npos;
  });
}

bool CanBeCompared(const Column& column) {
  const bool changes = std::ranges::any_of(column.value, [&column](double x) { return x != column.value.front(); });
  return column.IsNumber() && changes && !IsOtherQuantity(column) && !IsCalledError(column.name);
}

/// By a word that only one of the two files' names has; nothing if they say nothing.
std::optional<std::size_t> ReferenceByNames(const std::vector<Recording>& recordings) {
  const auto speaks = [&recordings](std::size_t file, Speaks of) {
    return Clearness(std::filesystem::path(recordings[file].file).stem().string(), of) > 0;
  };
  for (const Speaks of : {Speaks::kReference, Speaks::kDevice}) {
    if (speaks(0, of) == speaks(1, of)) continue;
    return speaks(0, of) == (of == Speaks::kReference) ? 0u : 1u;
  }
  return std::nullopt;
}

}  // namespace

bool TakeSideBySide(Map& map, std::vector<Recording>& recordings) {
  if (map.course.files != "auto" || !MayBeSides(recordings)) return false;
  if (SpeaksOfFiles(map)) {
    map.course.files = "series";
    return false;
  }
  if (!map.columns.empty() || !map.bench.empty() || !map.sought.empty()) return false;
  const std::vector<Column>& columns = recordings[0].tracks[0].columns;
  const auto says_side = [](const Column& c) { return Clearness(c.name, Speaks::kReference) > 0; };
  const auto by_names = ReferenceByNames(recordings);
  const bool is_single = std::ranges::count_if(columns, CanBeCompared) == 1;
  if (std::ranges::any_of(columns, says_side) || (!is_single && !by_names)) return false;
  const std::size_t reference = by_names.value_or(0), device = 1 - reference;
  std::vector<std::string> axes;
  std::vector<std::size_t> numbers;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (!CanBeCompared(columns[c]) || !CanBeCompared(recordings[1].tracks[0].columns[c])) continue;
    axes.push_back(columns[c].name);
    numbers.push_back(c);
  }
  if (axes.empty()) return false;
  const std::size_t axis = numbers[axes.size() == 1 && map.course.axis_number <= 1 ? 0 : ChosenOf(axes, map, recordings[0].remarks)];
  const auto put = [&](const std::string& target, std::size_t file) {
    const Track& track = recordings[file].tracks[0];
    const Choice choice{fmt::format("{}:{}", file + 1, track.columns[axis].name), &track.columns[axis], &track, &recordings[file]};
    Put(target, choice, by_names ? "by the name of its file" : "in the order of the files", map, recordings[0].remarks);
  };
  put("reference_deg", reference);
  put("measured_deg", device);
  map.course.files = "series";
  recordings[0].remarks.push_back("the files are taken side by side; as a mounting each: [course] files = \"setups\" in a map");
  return true;
}

}  // namespace twinbench::imports
