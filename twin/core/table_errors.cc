#include "twin/core/table_errors.h"

#include <fmt/format.h>

#include <algorithm>

#include "twin/core/csv.h"
#include "twin/core/errors.h"
#include "twin/core/units.h"

namespace twinbench {
namespace {

std::vector<double> ReadColumn(const CsvTable& table, const ErrorColumn& column) {
  const auto index = table.Column(column.name);
  std::vector<double> values(table.rows.size(), 0.0);
  for (std::size_t i = 0; index && i < values.size(); ++i)
    values[i] = CsvNumber(table, table.rows[i], *index, column.to_SI);
  return values;
}

std::vector<ErrorColumn> Columns() {
  std::vector<ErrorColumn> columns = {PositionColumn()};
  for (int c = 0; c < kComponents; ++c) columns.push_back(ColumnOf(static_cast<Component>(c)));
  return columns;
}

std::string HeaderLine() {
  std::string line;
  for (const ErrorColumn& column : Columns()) line += (line.empty() ? "" : ",") + column.name;
  return line;
}

void CheckColumns(const CsvTable& table) {
  for (const std::string& found : table.columns) {
    std::vector<std::string> known;
    for (const ErrorColumn& column : Columns()) known.push_back(column.name);
    if (std::ranges::find(known, found) == known.end())
      throw InputError(table.WhereHeader(), fmt::format("unknown column {}", found), "any of " + HeaderLine() + NearestColumn(found, known));
  }
  static_cast<void>(NeededColumn(table, PositionColumn().name, HeaderLine()));
  if (table.rows.empty()) throw InputError(table.WhereHeader(), "no rows follow the header", "one row a position");
}

}  // namespace

ErrorColumn ColumnOf(Component component) {
  const std::string name = kComponentNames[static_cast<std::size_t>(component)];
  if (IsAngle(component)) return {name + "_arcsec", units::arcsec};
  return {name + "_um", units::um};
}

ErrorColumn PositionColumn() {
  return {"position_deg", units::deg};
}

TableErrors ReadTableErrors(const std::string& path) {
  const CsvTable table = ReadCsv(path);
  CheckColumns(table);
  TableErrors errors;
  errors.position_rad = ReadColumn(table, PositionColumn());
  for (int c = 0; c < kComponents; ++c) {
    const auto component = static_cast<Component>(c);
    errors[component] = ReadColumn(table, ColumnOf(component));
  }
  return errors;
}

}  // namespace twinbench
