#include "twin/import/layouts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <nlohmann/json.hpp>

#include "twin/core/errors.h"
#include "twin/import/common.h"
#include "twin/import/table.h"
#include "twin/import/text.h"

namespace twinbench::imports {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostNames = 500, kFewestRecords = 3;
constexpr int kDeepest = 6;

/// Names and cells, written out as a table of text: which columns are numbers, times or words is found there.
class Sheet {
 public:
  void Put(const std::string& name, const Json& value, std::size_t row, int depth = 0) {
    if (value.is_structured()) return PutParts(name, value, row, depth);
    std::vector<std::string>* cells = CellsOf(name);
    if (!cells || value.is_null()) return;
    cells->resize(row + 1);
    (*cells)[row] = value.is_boolean() ? (value.get<bool>() ? "1" : "0")
                    : value.is_string() ? OnOneLine(value.get<std::string>())
                                        : value.dump();
    rows_ = std::max(rows_, row + 1);
  }

  std::size_t Rows() const { return rows_; }

  /// The record's number comes first, so that a row with gaps is a row all the same.
  std::string Text() const {
    std::string text = "record";
    for (const std::string& name : names_) text += "\t" + OnOneLine(name);
    for (std::size_t row = 0; row < rows_; ++row) {
      text += fmt::format("\n{}", row);
      for (const auto& cells : cells_) text += "\t" + (row < cells.size() ? cells[row] : std::string());
    }
    return text + "\n";
  }

 private:
  void PutParts(const std::string& name, const Json& value, std::size_t row, int depth) {
    if (depth >= kDeepest) return;
    if (value.is_array() && value.size() == 1) return Put(name, value[0], row, depth + 1);
    std::size_t index = 0;
    for (const auto& [key, part] : value.items()) {
      const std::string own = value.is_array() ? std::to_string(index++) : key;
      Put(name.empty() ? own : name + "." + own, part, row, depth + 1);
    }
  }

  std::vector<std::string>* CellsOf(const std::string& name) {
    const auto found = at_.find(name);
    if (found != at_.end()) return &cells_[found->second];
    if (names_.size() >= kMostNames) return nullptr;
    at_[name] = names_.size();
    names_.push_back(name);
    cells_.emplace_back();
    return &cells_.back();
  }

  static std::string OnOneLine(std::string text) {
    std::ranges::replace_if(text, [](char c) { return c == '\t' || c == '\n' || c == '\r' || c == '"'; }, ' ');
    return text;
  }

  std::vector<std::string> names_;
  std::map<std::string, std::size_t> at_;
  std::vector<std::vector<std::string>> cells_;
  std::size_t rows_ = 0;
};

/// Python writes numbers that are none by names that JSON does not have.
std::string WithoutNaN(std::string_view text) {
  std::string plain;
  plain.reserve(text.size());
  bool in_text = false;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] == '"' && (at == 0 || text[at - 1] != '\\')) in_text = !in_text;
    const std::string_view rest = text.substr(at);
    const std::string_view none = in_text ? "" : rest.starts_with("NaN") ? "NaN" : rest.starts_with("-Infinity") ? "-Infinity" : rest.starts_with("Infinity") ? "Infinity" : "";
    if (none.empty()) {
      plain += text[at];
    } else {
      plain += "null";
      at += none.size() - 1;
    }
  }
  return plain;
}

/// An object a line; a last line that was cut off, and lines of other text, are counted.
Json FromLines(std::string_view text, Recording& recording) {
  Json list = Json::array();
  std::size_t others = 0;
  Lines lines(text);
  for (std::string_view line; lines.Next(line);) {
    if (Trimmed(line).empty()) continue;
    Json record = Json::parse(line, nullptr, false);
    if (record.is_object()) {
      list.push_back(std::move(record));
    } else {
      ++others;
    }
  }
  if (others > 0) recording.left_out.push_back({others, "lines that are no object in JSON"});
  return others > list.size() ? Json() : list;
}

bool IsListOf(const Json& list, bool (*is)(const Json&)) {
  return list.is_array() && list.size() >= kFewestRecords && std::ranges::all_of(list, [is](const Json& entry) { return is(entry); });
}

/// A list, or as pandas has it an object of numbered entries.
bool IsColumn(const Json& part) {
  constexpr std::size_t kFewestNumbered = 12;
  return (part.is_array() && part.size() >= kFewestRecords) ||
         (part.is_object() && part.size() >= kFewestNumbered && std::ranges::none_of(part, [](const Json& e) { return e.is_structured(); }));
}

/// Lists of one length in an object: the length that most of them have.
std::size_t RowsOfColumns(const Json& object) {
  std::map<std::size_t, int> counts;
  for (const auto& [name, part] : object.items()) {
    if (IsColumn(part)) ++counts[part.size()];
  }
  const auto most = std::ranges::max_element(counts, {}, [](const auto& entry) { return entry.second; });
  return most == counts.end() || most->second < 2 ? 0 : most->first;
}

/// Several such objects in a list, each a run: all their rows.
std::size_t RowsOfRuns(const Json& list) {
  std::size_t rows = 0;
  for (const Json& run : list) {
    const std::size_t own = run.is_object() ? RowsOfColumns(run) : 0;
    if (own == 0) return 0;
    rows += own;
  }
  return rows;
}

/// Looks for what has the most rows, and writes the single numbers on the way down as named ones.
class Search {
 public:
  Search(Recording& recording, std::map<std::string, double>& numbers, std::vector<TextLine>& lines)
      : recording_(recording), numbers_(numbers), lines_(lines) {}

  void In(const Json& json, int depth = 0) {
    if (const std::size_t rows = json.is_array() ? RowsOfRuns(json) : 0; rows > 0) return Offer(rows, json, "a list of runs, each an object of lists");
    if (IsListOf(json, [](const Json& e) { return e.is_object(); })) return Offer(json.size(), json, "a list of objects");
    if (IsListOf(json, [](const Json& e) { return e.is_array() && !e.empty() && !e[0].is_structured(); }))
      return Offer(json.size(), json, "a list of rows");
    if (depth > kDeepest) return;
    for (std::size_t i = 0; json.is_array() && i < std::min(json.size(), kFewestRecords); ++i) In(json[i], depth + 1);  // a few recordings
    if (!json.is_object()) return;
    if (const std::size_t rows = RowsOfColumns(json); rows > 0) Offer(rows, json, "an object of lists");
    for (const auto& [name, part] : json.items()) {
      if (part.is_number()) numbers_[name] = part.get<double>();
      if (part.is_primitive()) lines_.push_back({0, name + ": " + part.dump()});
      if (part.is_structured()) In(part, depth + 1);
    }
  }

  Sheet Found() const {
    if (!best_) throw InputError(recording_.file, "the JSON has no list of records", "a list of objects, an object a line, or an object of lists of one length");
    recording_.layout = std::string("records in JSON, ") + what_;
    Sheet sheet;
    if (best_->is_object()) {
      PutColumns(*best_, sheet);
    } else if (RowsOfRuns(*best_) > 0) {
      for (const Json& run : *best_) PutColumns(run, sheet);
    } else {
      PutRows(sheet);
    }
    return sheet;
  }

 private:
  void Offer(std::size_t rows, const Json& json, const char* what) {
    if (rows <= rows_) return;
    rows_ = rows;
    best_ = &json;
    what_ = what;
  }

  /// What a run says once holds for all its rows.
  void PutColumns(const Json& run, Sheet& sheet) const {
    const std::size_t first = sheet.Rows(), rows = RowsOfColumns(run);
    for (const auto& [name, part] : run.items()) {
      std::size_t row = first;
      if (IsColumn(part) && part.size() == rows) {
        for (const Json& cell : part) sheet.Put(name, cell, row++);
      } else if (&run != best_ && part.is_primitive()) {
        while (row < first + rows) sheet.Put(name, part, row++);
      }
    }
  }

  /// A first row of texts has the names.
  void PutRows(Sheet& sheet) const {
    const Json& first = (*best_)[0];
    const bool named = first.is_array() && std::ranges::all_of(first, [](const Json& e) { return e.is_string(); });
    std::size_t row = 0;
    for (const Json& record : *best_) {
      if (!record.is_array()) {
        sheet.Put("", record, row++);
      } else if (!(named && &record == &first)) {
        for (std::size_t c = 0; c < record.size(); ++c)
          sheet.Put(named && c < first.size() ? first[c].get<std::string>() : fmt::format("column {}", c + 1), record[c], row);
        ++row;
      }
    }
  }

  Recording& recording_;
  std::map<std::string, double>& numbers_;
  std::vector<TextLine>& lines_;
  const Json* best_ = nullptr;
  std::size_t rows_ = 0;
  const char* what_ = "";
};

}  // namespace

bool OpensRecords(const std::vector<std::string_view>& lines) {
  std::string begin;
  for (const std::string_view line : lines) {
    for (const char c : line) {
      if (!std::isspace(static_cast<unsigned char>(c)) && begin.size() < 3) begin += c;
    }
  }
  if (begin.starts_with("{\"") || begin.starts_with("[{")) return true;
  return begin.starts_with("[[") && begin.size() == 3 && (std::isdigit(static_cast<unsigned char>(begin[2])) || begin[2] == '-' || begin[2] == '"');
}

void ReadRecords(std::string_view text, const Layout& layout, const ClockSettings& clock, Recording& recording) {
  const std::string plain = WithoutNaN(text);
  Json json = Json::parse(plain, nullptr, false);
  if (json.is_discarded()) json = FromLines(plain, recording);
  if (json.is_null()) throw InputError(recording.file, "it begins as JSON does and is none", "JSON, or an object in JSON a line");
  std::map<std::string, double> numbers;
  std::vector<TextLine> lines;
  Search search(recording, numbers, lines);
  search.In(json);
  const std::string table = search.Found().Text();
  const std::string layout_in_words = recording.layout;
  ReadTable(table, WithTabs(layout), clock, recording);
  recording.layout = layout_in_words;
  recording.usual_angle = "rad";  // what programs count in
  for (Track& track : recording.tracks) {
    std::erase_if(track.columns, [](const Column& column) { return column.name == "record"; });
    track.numbers.insert(numbers.begin(), numbers.end());
    track.lines.insert(track.lines.begin(), lines.begin(), lines.end());
    if (!track.HasClock()) TakeStatedRate(track);
  }
}

}  // namespace twinbench::imports
