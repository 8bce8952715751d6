#pragma once

#include "hw_bridge/numbers/number_source.h"

namespace twinbench::hw {

/// Attributes of an IIO device and of its channels: counters, encoders, anything that a driver shows as text. Each
/// is read by a request of its own.
std::unique_ptr<NumberSource> MakeIioNumbers(const NumberSettings& settings, const std::string& device,
                                             const std::string& where);

}  // namespace twinbench::hw
