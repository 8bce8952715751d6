#include "tests/scores/row.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "twin/core/errors.h"

namespace twinbench::scores {
namespace {

constexpr std::size_t kColumns = 4 + kMarkNames.size() + 2;

std::string Header() {
  std::string text = "set,bench,case,hidden";
  for (const char* name : kMarkNames) text += std::string(",") + name;
  return text + ",answer,seconds";
}

std::string Quoted(const std::string& text) {
  return "\"" + Unquoted(text) + "\"";
}

std::string MarkText(const std::optional<bool>& mark) {
  return mark ? (*mark ? "1" : "0") : "";
}

/// Fields of a line; a comma between quotes separates nothing.
std::vector<std::string> FieldsOf(const std::string& line) {
  std::vector<std::string> fields(1);
  bool is_quoted = false;
  for (const char c : line) {
    if (c == '"') is_quoted = !is_quoted;
    else if (c == ',' && !is_quoted) fields.emplace_back();
    else fields.back() += c;
  }
  return fields;
}

std::optional<bool> MarkOf(const std::string& text, const std::string& place) {
  if (text.empty()) return {};
  if (text != "0" && text != "1") throw InputError(place, "has the mark " + text, "1, 0 or nothing");
  return text == "1";
}

Row RowOf(const std::string& line, const std::string& place) {
  const std::vector<std::string> fields = FieldsOf(line);
  if (fields.size() != kColumns)
    throw InputError(place, fmt::format("has {} fields", fields.size()), fmt::format("{}: {}", kColumns, Header()));
  Row row{fields[0], fields[1], fields[2], fields[3]};
  for (std::size_t k = 0; k < row.marks.size(); ++k) row.marks[k] = MarkOf(fields[4 + k], place);
  row.answer = fields[kColumns - 2];
  const std::string& seconds = fields.back();
  const auto read = std::from_chars(seconds.data(), seconds.data() + seconds.size(), row.seconds);
  if (read.ec != std::errc{} || read.ptr != seconds.data() + seconds.size())
    throw InputError(place, "has the seconds " + seconds, "a number");
  return row;
}

}  // namespace

std::string Unquoted(std::string text) {
  std::ranges::replace(text, '"', '\'');
  std::ranges::replace(text, '\n', ' ');
  return text;
}

std::string Csv(const Rows& rows) {
  constexpr std::size_t kMostOfAnAnswer = 300;
  std::string text = Header() + "\n";
  for (const Row& row : rows) {
    text += fmt::format("{},{},{},{}", row.set, row.bench, Quoted(row.name), Quoted(row.hidden));
    for (const std::optional<bool>& mark : row.marks) text += "," + MarkText(mark);
    text += fmt::format(",{},{:.2f}\n", Quoted(row.answer.substr(0, kMostOfAnAnswer)), row.seconds);
  }
  return text;
}

Rows ParseRows(const std::string& text, const std::string& path) {
  std::istringstream in(text);
  std::string line;
  if (!std::getline(in, line) || line != Header()) throw InputError(path + ":1", "is no line of names", Header());
  Rows rows;
  std::set<std::string> keys;
  for (int number = 2; std::getline(in, line); ++number) {
    const std::string place = fmt::format("{}:{}", path, number);
    rows.push_back(RowOf(line, place));
    if (!keys.insert(rows.back().Key()).second)
      throw InputError(place, "is the second row of " + rows.back().Key(), "one row a case");
  }
  return rows;
}

Rows ReadRows(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw InputError(path, "cannot be read", "a file that scores -o has written");
  std::ostringstream text;
  text << in.rdbuf();
  return ParseRows(text.str(), path);
}

void WriteWhole(const std::string& path, const std::string& text) {
  const std::string beside = path + ".part";
  std::ofstream(beside) << text;
  std::error_code failed;
  std::filesystem::rename(beside, path, failed);
  if (failed) throw InputError(path, "cannot be written", "a file in a folder that exists");
}

}  // namespace twinbench::scores
