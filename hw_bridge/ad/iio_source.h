#pragma once

#include <memory>

#include "hw_bridge/ad/ad_source.h"

namespace twinbench::hw {

/// Any board that libiio reaches: over the network, USB, on this machine, or (attributes only) an XML description.
///
/// One block is one buffer of so many samples, refilled once and closed. The channels asked for and `timestamp` are
/// enabled and no others. libiio does not report lost scans, so the step of the time stamps is looked at scan by
/// scan; a device without `timestamp` is taken, but `stamps_scans` is false.
std::unique_ptr<AdSource> MakeIioSource(const AdSettings& settings);

}  // namespace twinbench::hw
