#include "twin/import/layouts.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>

#include "twin/import/common.h"
#include "twin/import/run_names.h"
#include "twin/import/text.h"
#include "twin/import/unit_names.h"

namespace twinbench::imports {
namespace {

struct Entry {
  std::string name;
  std::vector<int> index;  // one or two
  std::string_view value;
};

std::optional<Entry> EntryOf(std::string_view line) {
  const std::size_t equals = line.find('='), open = line.find_first_of("[("), close = line.find_first_of("])");
  if (equals == std::string_view::npos || open == 0 || open >= close || close >= equals) return std::nullopt;
  Entry entry{std::string(Trimmed(line.substr(0, open))), {}, Trimmed(line.substr(equals + 1))};
  for (std::string_view rest = line.substr(open + 1, close - open - 1); !rest.empty();) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    const std::string_view digits = Trimmed(rest.substr(0, comma));
    int index = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
    if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
    entry.index.push_back(index);
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  const bool is_one = (entry.index.size() == 1 || entry.index.size() == 2) && FieldNumber(entry.value, false);
  return is_one ? std::optional(entry) : std::nullopt;
}

using CellsOfRuns = std::map<int, std::map<int, std::string_view>>;  // as the file has them, by run, then by row

struct Indexed {
  std::map<int, std::string_view> target;
  std::map<std::string, CellsOfRuns> arrays;
  std::string unit;
};

Indexed Read(std::string_view text) {
  Indexed read;
  Lines lines(text);
  for (std::string_view line; lines.Next(line);) {
    const auto entry = EntryOf(line);
    if (entry && entry->index.size() == 1) read.target[entry->index[0]] = entry->value;
    if (entry && entry->index.size() == 2) read.arrays[entry->name][entry->index[1]][entry->index[0]] = entry->value;
    const std::size_t equals = line.find('=');
    if (!entry && equals != std::string_view::npos && SmallLetters(Trimmed(line.substr(0, equals))) == "unit")
      read.unit = Trimmed(line.substr(equals + 1));
  }
  return read;
}

/// Every run of every array that is as long as the targets.
std::vector<std::pair<std::string, std::map<int, std::string_view>>> NamedRuns(const Indexed& read) {
  std::vector<std::pair<std::string, std::map<int, std::string_view>>> named;
  for (const auto& [array, runs] : read.arrays) {
    const int direction = DirectionIn(array);
    for (const auto& [number, run] : runs) {
      const char* sense = direction > 0 ? " up" : direction < 0 ? " down" : "";
      if (run.size() == read.target.size()) named.emplace_back(fmt::format("run {}{}", number, sense), run);
    }
  }
  return named;
}

}  // namespace

bool AreIndexed(const std::vector<std::string_view>& lines) {
  constexpr std::size_t kFewest = 6;
  std::size_t entries = 0, with_runs = 0;
  for (const std::string_view line : lines) {
    const auto entry = EntryOf(line);
    entries += entry ? 1 : 0;
    with_runs += entry && entry->index.size() == 2 ? 1 : 0;
  }
  return with_runs >= kFewest && 3 * entries > 2 * lines.size();
}

std::string TableOfIndexed(std::string_view text) {
  const Indexed read = Read(text);
  const auto runs = NamedRuns(read);
  if (read.target.empty() || runs.empty()) return "";
  const std::string unit = read.unit.empty() ? "" : " [" + read.unit + "]";
  std::string table = "target" + unit;
  for (const auto& [name, run] : runs) table += "\t" + name + unit;
  for (const auto& [row, target] : read.target) {
    table += "\n" + std::string(target);
    for (const auto& [name, run] : runs) {
      const auto cell = run.find(row);
      table += "\t" + std::string(cell == run.end() ? "" : cell->second);
    }
  }
  return table + "\n";
}

}  // namespace twinbench::imports
