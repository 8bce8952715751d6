#include "twin/import/said.h"

#include <algorithm>

namespace twinbench::imports {
namespace {

const MappedColumn* Find(const Map& map, const std::string& column) {
  const auto found = std::ranges::find(map.columns, column, &MappedColumn::column);
  return found == map.columns.end() ? nullptr : &*found;
}

}  // namespace

std::string NameOf(const Map& map, const std::string& column) {
  const MappedColumn* mapped = Find(map, column);
  if (!mapped) return column;
  return mapped->where.empty() ? "\"" + mapped->expression + "\"" : mapped->where;
}

std::string ExpressionOf(const Map& map, const std::string& column) {
  const MappedColumn* mapped = Find(map, column);
  if (!mapped) return column;
  const bool is_name = mapped->where.empty() || mapped->expression.find_first_of("+*/()[]") == std::string::npos;
  return is_name ? "[" + mapped->expression + "]" : "(" + mapped->expression + ")";
}

std::string KeyOf(const Map& map, const std::string& column) {
  const MappedColumn* mapped = Find(map, column);
  return mapped && !mapped->unit.empty() ? BaseOf(column) + "_" + mapped->unit : column;
}

}  // namespace twinbench::imports
