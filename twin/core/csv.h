#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace twinbench {

/// A comma separated file: one header line, one line a row, `#` lines are comments, `"` quotes a field.
struct CsvTable {
  struct Row {
    int line = 0;  // in the file, from 1
    std::vector<std::string> fields;
  };
  std::string name;  // of the file, for messages
  int header_line = 0;
  std::vector<std::string> columns;
  std::vector<Row> rows;

  std::optional<std::size_t> Column(std::string_view column) const;
  std::string Where(const Row& row) const;  // "file.csv:7"
  std::string WhereHeader() const;
};

/// @throws InputError with file:line if there is no header, a column has no name or comes twice, a row has another
///         number of fields than the header, or a quote is not closed.
CsvTable ParseCsv(std::istream& in, const std::string& name);

/// @throws InputError if the file cannot be opened.
CsvTable ReadCsv(const std::string& path);

/// The column of that name.
/// @throws InputError that names it and, if there is one, a column of nearly that name or of the same in another unit.
std::size_t NeededColumn(const CsvTable& table, const std::string& name, const std::string& expected);

/// "; the nearest is mesured_deg" if one of `present` is nearly `wanted` or the same in another unit; else "".
std::string NearestColumn(const std::string& wanted, const std::vector<std::string>& present);

/// The field, quoted if it would be read as something else.
std::string QuoteCsv(const std::string& field);

/// The field of `row` in `column` as a number times `to_SI`.
/// @throws InputError naming file, line and column if it is none.
double CsvNumber(const CsvTable& table, const CsvTable::Row& row, std::size_t column, double to_SI);

}  // namespace twinbench
