#pragma once

#include <memory>
#include <string>

#include "hw_bridge/ad/ad_source.h"
#include "hw_bridge/ad/block_checks.h"
#include "hw_bridge/ad/clock_watch.h"
#include "twin/core/devices.h"
#include "twin/core/scenario.h"

namespace twinbench::hw {

/// An A/D card as an A/D converter of the bench: blocks in channel order, judged and averaged.
class AdFrontEnd : public AdConverter {
 public:
  /// What the card answered when it was configured; for the record.
  virtual const Negotiated& Actual() const = 0;
  /// Card, serial number, driver, rate, resolution, range; one line.
  virtual std::string Identity() const = 0;
  /// Of the last block that was looked at, with its mains amplitude.
  virtual const BlockFindings& Findings() const = 0;
  /// Largest mains amplitude of each channel so far [V]; NaN: no block was as long as a period.
  virtual const std::array<double, kChannels>& LargestMains_V() const = 0;
  /// Of the card's clock against the bench's.
  virtual ClockWatch::Drift ClockDrift() const = 0;
};

/// Opens and configures the card of a bench file. Its blocks have the bits that the twin's have for the same codes:
/// channel order, code * range / 2^(bits - 1), saturated channels without mean and deviation, no numbers at all
/// without light. The raw counts always come along. A calibration file replaces range and bits by its polynomials.
/// A block starts when it is asked for, by the bench's clock; the card's own time is in its stamp.
///
/// Acquire throws DeviceFault for whatever the source throws, and kChannelSlip, kSignalLost, kStuck, kClock from
/// the block itself; the call after a fault starts afresh.
///
/// @param clock    Of the bench; must outlive the converter.
/// @param noise_V  To expect of one sample, standard deviation; 0: not known. Tells a stuck channel from a quiet
/// one.
/// @throws InputError  if this build has no such driver.
/// @throws DeviceFault kRefused if rate (beyond rate_tolerance), range or resolution is not that of the scenario,
/// naming
///                     both, or if the calibration file does not fit; kIdentity for another serial number;
///                     kTimeout, kDropped if it does not answer.
std::unique_ptr<AdFrontEnd> MakeAdConverter(const AdSettings& settings, const AdcSettings& scenario_adc,
                                            const Clock& clock, double noise_V = 0.0);

/// The same over any source.
std::unique_ptr<AdFrontEnd> MakeAdConverter(std::unique_ptr<AdSource> source, const AdSettings& settings,
                                            const AdcSettings& scenario_adc, const Clock& clock,
                                            double noise_V = 0.0);

}  // namespace twinbench::hw
