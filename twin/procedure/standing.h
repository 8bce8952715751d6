#pragma once

#include "twin/core/devices.h"
#include "twin/core/machine.h"
#include "twin/procedure/standstill.h"

namespace twinbench::procedure {

/// Whether both tables stand: nothing is told to them, their controllers are asked twice, and no encoder may have moved between the two
/// looks. They are real seconds apart by 0.05; a simulated bench's own time stands between its calls anyway.
/// @throws DeviceFault, BenchError where a controller does not answer.
Standstill WhetherBothStand(RotaryBench& bench);

/// The same of a machine's axes.
Standstill WhetherMachineStands(MachineBench& bench);

}  // namespace twinbench::procedure
