#pragma once

#include <map>
#include <string>
#include <vector>

#include "twin/core/csv.h"

namespace twinbench::test {

using CsvRow = std::map<std::string, std::string>;  // by column

/// Rows of a table of the independent oracle.
inline std::vector<CsvRow> ReadCsvRows(const std::string& path) {
  const CsvTable table = ReadCsv(path);
  std::vector<CsvRow> rows;
  for (const CsvTable::Row& row : table.rows) {
    rows.emplace_back();
    for (std::size_t i = 0; i < row.fields.size(); ++i) rows.back()[table.columns[i]] = row.fields[i];
  }
  return rows;
}

inline double Number(const CsvRow& row, const std::string& column) {
  return std::stod(row.at(column));
}

}  // namespace twinbench::test
