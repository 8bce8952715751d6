#pragma once

#include "hw_bridge/numbers/number_source.h"

namespace twinbench::hw {

/// Channels of a card by comedilib, one instruction each: counts of counters and encoders; analogue inputs in volts
/// of their first range.
std::unique_ptr<NumberSource> MakeComediNumbers(const NumberSettings& settings, const std::string& device,
                                                const std::string& where);

}  // namespace twinbench::hw
