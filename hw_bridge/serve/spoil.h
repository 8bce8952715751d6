#pragma once

#include "hw_bridge/serve/faults.h"
#include "hw_bridge/serve/scan_stream.h"

namespace twinbench::hw {

inline constexpr std::int64_t kGapScans = 16;

/// Does to a block that was taken what a fault of the card would have done to it; faults of the connection leave
/// it.
void Spoil(ScanBlock& block, Injected fault, const AdcSettings& adc);
/// The same for a clock of the card that is not the bench's.
void SpoilStamps(ScanBlock& block, Injected fault);

}  // namespace twinbench::hw
