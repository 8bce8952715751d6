#include "twin/core/machine.h"

#include "twin/core/device_fault.h"

namespace twinbench {

void MachineController::StartTurning(std::size_t axis, double, Duration) {
  throw DeviceFault(FaultKind::kRefused, Axes()[axis].name, "this axis does not turn on and on");
}

bool IsOfInstruments(const ReadingColumn& column) {
  const bool is_read = column.IsShown() || column.name == kTemperatureColumn || column.name == kReferenceColumn;
  return column.number && is_read;
}

std::vector<ReadingColumn> InstrumentColumns(const std::vector<ReadingColumn>& columns) {
  std::vector<ReadingColumn> shown;
  for (const ReadingColumn& column : columns) {
    if (IsOfInstruments(column)) shown.push_back(column);
  }
  return shown;
}

}  // namespace twinbench
