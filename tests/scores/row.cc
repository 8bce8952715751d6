#include "tests/scores/sets.h"

#include <fmt/ranges.h>

#include "twin/core/csv.h"
#include "twin/core/errors.h"
#include "twin/core/whole_file.h"

namespace twinbench::scores {
namespace {

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

std::optional<bool> MarkOf(const std::string& text, const std::string& place) {
  if (text.empty()) return {};
  if (text != "0" && text != "1") throw InputError(place, "has the mark " + text, "1, 0 or nothing");
  return text == "1";
}

Row RowOf(const CsvTable& table, const CsvTable::Row& line) {
  const std::vector<std::string>& fields = line.fields;
  Row row{fields[0], fields[1], fields[2], fields[3]};
  for (std::size_t k = 0; k < row.marks.size(); ++k) row.marks[k] = MarkOf(fields[4 + k], table.Where(line));
  row.answer = fields[fields.size() - 2];
  row.seconds = CsvNumber(table, line, fields.size() - 1, 1.0);
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
  const CsvTable table = ParseCsv(in, path);
  if (fmt::format("{}", fmt::join(table.columns, ",")) != Header())
    throw InputError(table.WhereHeader(), "is no line of names", Header());
  Rows rows;
  std::set<std::string> keys;
  for (const CsvTable::Row& line : table.rows) {
    rows.push_back(RowOf(table, line));
    if (!keys.insert(rows.back().Key()).second)
      throw InputError(table.Where(line), "is the second row of " + rows.back().Key(), "one row a case");
  }
  return rows;
}

Rows ReadRows(const std::string& path) {
  return ParseRows(BytesOfFile(path), path);
}

}  // namespace twinbench::scores
