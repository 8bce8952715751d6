#pragma once

#include <array>
#include <string>
#include <vector>

#include "hw_bridge/ad/ad_source.h"
#include "twin/core/scenario.h"

namespace twinbench::hw {

/// Channel of each place in the scan.
std::array<std::size_t, kChannels> ScanOrderOf(const AdcSettings& adc);

/// What a scenario asks of the card of a bench file: its channels in the scenario's scan order.
ScanSpec SpecOf(const AdSettings& settings, const AdcSettings& adc);

/// @throws DeviceFault kRefused, kIdentity unless the card does what the scenario asks and is the one expected.
void RequireAsAsked(const Negotiated& actual, const AdSettings& settings, const AdcSettings& adc);

/// One line for the record.
std::string Describe(const Negotiated& actual);

/// Every channel in full, one line each: input, range, wiring, skew against the first, polynomial from codes to
/// volts.
std::vector<std::string> DescribeChannels(const Negotiated& actual);

}  // namespace twinbench::hw
