#pragma once

#include "hw_bridge/numbers/number_source.h"

namespace twinbench::hw {

/// Channels of a card by comedilib, one instruction each: counts of counters and encoders; analogue inputs in volts
/// of their first range.
std::unique_ptr<NumberSource> MakeComediNumbers(const NumberSettings& settings, const std::string& device,
                                                const std::string& where);

/// Attributes of an IIO device and of its channels: counters, encoders, anything that a driver shows as text. Each
/// is read by a request of its own.
std::unique_ptr<NumberSource> MakeIioNumbers(const NumberSettings& settings, const std::string& device,
                                             const std::string& where);

/// Registers of a Modbus device, over TCP or a serial line (RTU), by libmodbus. Registers that stand side by side
/// are read by one request, so that they are of one instant.
std::unique_ptr<NumberSource> MakeModbusNumbers(const NumberSettings& settings, const std::string& device,
                                                const std::string& where);

}  // namespace twinbench::hw
