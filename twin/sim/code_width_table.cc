#include "twin/sim/code_width_table.h"

#include <fmt/format.h>

#include <cmath>

#include "twin/core/csv.h"
#include "twin/core/errors.h"

namespace twinbench::sim {
namespace {

/// Where a file has its widths, and what is taken off them.
struct WidthColumn {
  std::size_t at;
  double width_of_0;
};

WidthColumn WidthColumnOf(const CsvTable& table) {
  const auto width = table.Column("width"), dnl = table.Column("dnl_lsb");
  if (width && dnl)
    throw InputError(table.WhereHeader(), "says each width twice, as width and as dnl_lsb", "one of them");
  if (!width && !dnl)
    throw InputError(table.WhereHeader(), "a column is missing", "code and width, or code and dnl_lsb");
  return width ? WidthColumn{*width, 0.0} : WidthColumn{*dnl, 1.0};
}

std::int32_t CodeIn(const CsvTable& table, const CsvTable::Row& row, std::size_t column, int bits) {
  const double code = CsvNumber(table, row, column, 1.0), half = std::ldexp(1.0, bits - 1);
  if (code != std::floor(code) || code < -half || code >= half)
    throw InputError(table.Where(row), fmt::format("code is {:g}", code),
                     fmt::format("a whole number from {:g} to {:g}, for {} bits", -half, half - 1.0, bits));
  return static_cast<std::int32_t>(code);
}

double ExcessIn(const CsvTable& table, const CsvTable::Row& row, const WidthColumn& column) {
  const double width_lsb = CsvNumber(table, row, column.at, 1.0) + column.width_of_0;
  if (!(width_lsb >= 0.0) || !std::isfinite(width_lsb))
    throw InputError(table.Where(row), fmt::format("a code is {:g} LSB wide", width_lsb), "0 or more");
  return width_lsb - 1.0;
}

}  // namespace

std::map<std::int32_t, double> ReadExcessWidths_lsb(const std::string& path, int bits) {
  const CsvTable table = ReadCsv(path);
  const std::size_t code_column = NeededColumn(table, "code", "code and width, or code and dnl_lsb");
  const WidthColumn width_column = WidthColumnOf(table);
  std::map<std::int32_t, double> excess_lsb;
  for (const CsvTable::Row& row : table.rows) {
    const std::int32_t code = CodeIn(table, row, code_column, bits);
    if (!excess_lsb.empty() && code <= excess_lsb.rbegin()->first)
      throw InputError(table.Where(row), fmt::format("code {} comes behind {}", code, excess_lsb.rbegin()->first),
                       "codes in their order, each once");
    excess_lsb.emplace_hint(excess_lsb.end(), code, ExcessIn(table, row, width_column));
  }
  if (excess_lsb.empty()) throw InputError(table.name, "holds no rows", "a row a code");
  return excess_lsb;
}

}  // namespace twinbench::sim
