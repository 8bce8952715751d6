#include "twin/core/machine.h"

namespace twinbench {

std::vector<ReadingColumn> InstrumentColumns(const std::vector<ReadingColumn>& columns) {
  std::vector<ReadingColumn> shown;
  for (const ReadingColumn& column : columns) {
    if (column.number && (column.IsShown() || column.name == kTemperatureColumn)) shown.push_back(column);
  }
  return shown;
}

}  // namespace twinbench
