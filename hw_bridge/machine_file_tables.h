#pragma once

#include <fmt/format.h>

#include <string>

#include "hw_bridge/machine_file.h"

/// What stands behind a machine's bench file: names of its tables, and what its keys say together.
namespace twinbench::hw {

inline std::string InstrumentTable(std::size_t number) {
  return fmt::format("instrument_{}", number + 1);
}

inline std::string AxisTable(const MachineAxis& axis) {
  return "axis_" + axis.name;
}

/// @throws InputError where keys contradict each other or what the machine is.
void CheckMachineFile(const MachineFile& file, const std::vector<MachineAxis>& axes);

}  // namespace twinbench::hw
