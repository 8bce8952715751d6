#include "twin/import/layouts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>

#include "twin/import/text.h"

namespace twinbench::imports {
namespace {

struct NamedValues {
  std::string_view name;
  std::vector<std::string_view> values;
  bool is_list = false;
};

/// The fields of "[1, 2.5 -3]"; nothing if one is no number.
std::vector<std::string_view> FieldsOfList(std::string_view list) {
  constexpr std::string_view kBetweenFields = ", ;\t";
  std::vector<std::string_view> fields;
  for (std::size_t at = 0; (at = list.find_first_not_of(kBetweenFields, at)) != std::string_view::npos;) {
    const std::size_t end = std::min(list.find_first_of(kBetweenFields, at), list.size());
    fields.push_back(list.substr(at, end - at));
    if (!FieldNumber(fields.back(), false)) return {};
    at = end;
  }
  return fields;
}

std::optional<NamedValues> NamedValuesIn(std::string_view line) {
  line = Trimmed(line);
  const std::size_t mark = line.find_first_of(":=");
  if (mark == std::string_view::npos || mark == 0 || !std::isalpha(static_cast<unsigned char>(line[0]))) return std::nullopt;
  NamedValues named{Trimmed(line.substr(0, mark)), {}, false};
  const std::string_view value = Trimmed(line.substr(mark + 1));
  if (value.empty() || named.name.find_first_of("[({") != std::string_view::npos) return std::nullopt;
  named.is_list = (value.front() == '[' && value.back() == ']') || (value.front() == '(' && value.back() == ')');
  named.values = named.is_list ? FieldsOfList(value.substr(1, value.size() - 2)) : std::vector{value};
  return named.values.empty() ? std::nullopt : std::optional(named);
}

/// The records, and the names in the order in which they come.
class RecordsOfLists {
 public:
  void Take(std::string_view line) {
    const auto named = NamedValuesIn(line);
    if (!named) {
      others_ += std::string(line) + "\n";
      return;
    }
    if (record_.contains(CellName(*named, 0))) End();
    for (std::size_t k = 0; k < named->values.size(); ++k) {
      const std::string name = CellName(*named, k);
      record_[name] = named->values[k];
      if (std::ranges::find(names_, name) == names_.end()) names_.push_back(name);
    }
  }

  std::string Text() {
    End();
    std::string text;
    for (const std::string& name : names_) text += (text.empty() ? "" : "\t") + name;
    text += "\n";
    for (const auto& [above, record] : records_) {
      text += above;
      for (std::size_t c = 0; c < names_.size(); ++c) {
        const auto cell = record.find(names_[c]);
        text += (c > 0 ? "\t" : "") + std::string(cell == record.end() ? "" : cell->second);
      }
      text += "\n";
    }
    return text;
  }

 private:
  static std::string CellName(const NamedValues& named, std::size_t k) {
    return named.is_list ? fmt::format("{}.{}", named.name, k) : std::string(named.name);
  }

  void End() {
    if (!record_.empty()) records_.emplace_back(std::move(others_), std::move(record_));
    others_.clear();
    record_.clear();
  }

  std::vector<std::string> names_;
  std::map<std::string, std::string_view> record_;
  std::string others_;  // lines before the record
  std::vector<std::pair<std::string, std::map<std::string, std::string_view>>> records_;
};

}  // namespace

bool AreNamedLists(const std::vector<std::string_view>& lines) {
  constexpr int kFewestTimes = 3;
  std::map<std::string_view, int> times;
  std::ptrdiff_t lists = 0;
  for (const std::string_view line : lines) {
    const auto named = NamedValuesIn(line);
    if (!named || !named->is_list) continue;
    ++times[named->name];
    ++lists;
  }
  const auto again = std::ranges::count_if(times, [](const auto& entry) { return entry.second >= kFewestTimes; });
  return again >= 2 && 3 * lists > std::ssize(lines);
}

std::string TableOfNamedLists(std::string_view text) {
  RecordsOfLists records;
  Lines lines(text);
  for (std::string_view line; lines.Next(line);) {
    if (!Trimmed(line).empty()) records.Take(line);
  }
  return records.Text();
}

}  // namespace twinbench::imports
