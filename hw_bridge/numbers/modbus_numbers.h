#pragma once

#include "hw_bridge/numbers/number_source.h"

namespace twinbench::hw {

/// Registers of a Modbus device, over TCP or a serial line (RTU), by libmodbus. Registers that stand side by side
/// are read by one request, so that they are of one instant.
std::unique_ptr<NumberSource> MakeModbusNumbers(const NumberSettings& settings, const std::string& device,
                                                const std::string& where);

}  // namespace twinbench::hw
