#pragma once

#include <cstdint>
#include <vector>

#include "twin/campaign/trial.h"

namespace twinbench::campaign {

/// A row on its way between processes (CBOR); numbers keep their bits.
std::vector<std::uint8_t> MessageOf(const TrialRow& row);
TrialRow RowOf(const std::vector<std::uint8_t>& message);

}  // namespace twinbench::campaign
