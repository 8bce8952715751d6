#include "twin/core/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <istream>

#include "twin/core/errors.h"
#include "twin/core/input_text.h"
#include "twin/core/nearest_key.h"
#include "twin/core/number_text.h"

namespace twinbench {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

std::string Trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Takes one field off `line` from `at` on, which then stands on the comma behind it or at the end.
std::string TakeField(const std::string& line, std::size_t& at, const std::string& where) {
  const std::size_t first = line.find_first_not_of(" \t", at);
  if (first == std::string::npos || line[first] != '"') {
    const std::size_t begin = at;
    at = std::min(line.find(',', begin), line.size());
    return Trimmed(line.substr(begin, at - begin));
  }
  std::string field;
  for (at = first + 1; at < line.size(); ++at) {
    if (line[at] != '"') {
      field += line[at];
    } else if (at + 1 < line.size() && line[at + 1] == '"') {
      field += line[at++];
    } else {
      at = std::min(line.find(',', at), line.size());
      return field;
    }
  }
  throw InputError(where, "a quote is opened and not closed", "a \" at the end of the field");
}

std::vector<std::string> SplitLine(const std::string& line, const std::string& where) {
  std::vector<std::string> fields;
  for (std::size_t at = 0;; ++at) {
    fields.push_back(TakeField(line, at, where));
    if (at >= line.size()) return fields;
  }
}

void CheckHeader(const CsvTable& table) {
  constexpr std::size_t kMostColumns = 4096;
  if (table.columns.size() > kMostColumns)
    throw InputError(table.WhereHeader(), fmt::format("{} columns", table.columns.size()), fmt::format("at most {}", kMostColumns));
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const std::string& column = table.columns[i];
    if (column.empty())
      throw InputError(table.WhereHeader(), fmt::format("column {} has no name", i + 1), "a name");
    if (std::count(table.columns.begin(), table.columns.end(), column) > 1)
      throw InputError(table.WhereHeader(), fmt::format("column {} comes twice", column), "every column once");
  }
}

void CheckRow(const CsvTable& table, const CsvTable::Row& row) {
  if (row.fields.size() == table.columns.size()) return;
  throw InputError(table.Where(row), fmt::format("{} fields", row.fields.size()),
                   fmt::format("{}, as in the header", table.columns.size()));
}

void TakeLine(CsvTable& table, const std::string& line, int number) {
  if (Trimmed(line).empty() || line[0] == '#') return;
  const std::string where = fmt::format("{}:{}", table.name, number);
  if (table.header_line == 0) {
    table.header_line = number;
    table.columns = SplitLine(line, where);
    CheckHeader(table);
  } else {
    table.rows.push_back({number, SplitLine(line, where)});
    CheckRow(table, table.rows.back());
  }
}

}  // namespace

std::optional<std::size_t> CsvTable::Column(std::string_view column) const {
  const auto found = std::find(columns.begin(), columns.end(), column);
  if (found == columns.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns.begin());
}

std::string CsvTable::Where(const Row& row) const {
  return fmt::format("{}:{}", name, row.line);
}

std::string CsvTable::WhereHeader() const {
  return fmt::format("{}:{}", name, header_line);
}

CsvTable ParseCsv(std::istream& in, const std::string& name) {
  CsvTable table;
  table.name = name;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (number == 1 && line.starts_with(kByteOrderMark)) line.erase(0, kByteOrderMark.size());
    if (!line.empty() && line.back() == '\r') line.pop_back();
    TakeLine(table, line, number);
  }
  if (in.bad()) throw InputError(name, "the file cannot be read to its end", "a readable file");
  if (table.header_line == 0) throw InputError(name + ":1", "the file has no header line", "names of columns");
  return table;
}

CsvTable ReadCsv(const std::string& path) {
  std::istringstream in(InputText(path, "a table (CSV)"));
  return ParseCsv(in, path);
}

std::string NearestColumn(const std::string& wanted, const std::vector<std::string>& present) {
  const std::string base = wanted.substr(0, wanted.rfind('_') + 1);
  for (const std::string& column : present) {
    if (!base.empty() && column.substr(0, column.rfind('_') + 1) == base) return "; the nearest is " + column;
  }
  const std::string nearest = Nearest(wanted, present);
  const int slip = std::max(1, static_cast<int>(wanted.size()) / 3);
  return nearest.empty() || EditDistance(wanted, nearest) > slip ? "" : "; the nearest is " + nearest;
}

std::size_t NeededColumn(const CsvTable& table, const std::string& name, const std::string& expected) {
  if (const auto column = table.Column(name)) return *column;
  throw InputError(table.WhereHeader(), fmt::format("the column {} is missing", name), expected + NearestColumn(name, table.columns));
}

std::string QuoteCsv(const std::string& field) {
  const bool plain =
      field.find_first_of(",\"") == std::string::npos && Trimmed(field) == field && !field.starts_with('#');
  if (plain) return field;
  std::string quoted = "\"";
  for (const char c : field) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

double CsvNumber(const CsvTable& table, const CsvTable::Row& row, std::size_t column, double to_SI) {
  const std::string& field = row.fields[column];
  if (const auto number = ParseInUnit(field, to_SI)) return *number;
  throw InputError(table.Where(row), fmt::format("{} is \"{}\"", table.columns[column], field), "a finite number");
}

}  // namespace twinbench
