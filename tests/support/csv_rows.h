#pragma once

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace twinbench::test {

using CsvRow = std::map<std::string, std::string>;  // by column

/// Rows of a plain table of the independent oracle: a header, no quotes, line ends of any system.
inline std::vector<CsvRow> ReadCsvRows(const std::string& path) {
  const auto split = [](const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell.substr(0, cell.find('\r')));
    return cells;
  };
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> names = split(line);
  std::vector<CsvRow> rows;
  while (std::getline(file, line)) {
    const std::vector<std::string> cells = split(line);
    rows.emplace_back();
    for (std::size_t i = 0; i < cells.size(); ++i) rows.back()[names[i]] = cells[i];
  }
  return rows;
}

inline double Number(const CsvRow& row, const std::string& column) {
  return std::stod(row.at(column));
}

}  // namespace twinbench::test
