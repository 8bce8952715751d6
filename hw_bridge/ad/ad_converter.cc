#include "hw_bridge/ad/ad_converter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hw_bridge/ad/negotiation.h"
#include "hw_bridge/ad/volts.h"
#include "twin/core/block_statistics.h"
#include "twin/core/device_fault.h"

namespace twinbench::hw {
namespace {

constexpr const char* kDevice = "adc";

ReadingStatus StatusOfLight(const std::string& light) {
  if (light == "no_light") return ReadingStatus::kNoLight;
  return light == "clipped_spot" ? ReadingStatus::kClippedSpot : ReadingStatus::kOk;
}

/// @throws DeviceFault for what makes a block worthless. A lost word turns every channel behind it, so that one is
/// first.
void ThrowIfSpoiled(const BlockFindings& found, double noise_lsb) {
  if (found.slip.scan >= 0) {
    throw DeviceFault(FaultKind::kChannelSlip, kDevice,
                      "the channels are turned by " + std::to_string(found.slip.places) + " from scan " +
                          std::to_string(found.slip.scan) + " on");
  }
  if (found.floating_mask != 0) {
    throw DeviceFault(FaultKind::kSignalLost, kDevice,
                      ChannelsIn(found.floating_mask) + " looks like an open input: check the cable");
  }
  if (found.stuck_mask != 0) {
    const std::string expected = noise_lsb > 0.0 ? "the " + std::to_string(noise_lsb) + " codes of the scenario"
                                                 : "that of the other channels";
    throw DeviceFault(FaultKind::kStuck, kDevice,
                      ChannelsIn(found.stuck_mask) + " stays on one code, without noise like " + expected);
  }
}

class CardConverter : public AdFrontEnd {
 public:
  CardConverter(std::unique_ptr<AdSource> source, const AdSettings& settings, const AdcSettings& adc,
                const Clock& clock, double noise_V)
      : source_(std::move(source)), clock_(clock), order_(ScanOrderOf(adc)) {
    actual_ = source_->Configure(SpecOf(settings, adc));
    RequireAsAsked(actual_, settings, adc);
    lsb_V_ = adc.range_V / static_cast<double>(1 << (adc.bits - 1));
    checks_ = {.bits = adc.bits,
               .scan_rate_Hz = actual_.actual.scan_rate_Hz,
               .scan_order = order_,
               .mains_Hz = settings.mains_Hz,
               .noise_lsb = noise_V / lsb_V_};
  }

  Acquisition Acquire(int n_samples, bool /*keep_raw*/) override {
    Require(n_samples > 0, "a block has at least one sample");
    const Time start = clock_.Now();
    AdBlock taken = Take(n_samples);
    if (taken.stamp.device_ns >= 0) CompareClocks(taken.stamp.device_ns, start, n_samples);
    Acquisition block;
    block.start = start;
    block.stamp = taken.stamp;
    block.stamp.first_scan = CountScans(taken.stamp.device_ns, n_samples);
    block.status = StatusOfLight(taken.light);
    block.raw = InChannelOrder(std::move(taken.raw));
    if (block.status == ReadingStatus::kOk) Judge(block, n_samples);
    return block;
  }

  const Negotiated& Actual() const override { return actual_; }
  std::string Identity() const override { return Describe(actual_); }
  const BlockFindings& Findings() const override { return found_; }
  const std::array<double, kChannels>& LargestMains_V() const override { return mains_V_; }
  ClockWatch::Drift ClockDrift() const override { return watch_.DriftSoFar(); }

 private:
  AdBlock Take(int n_samples) {
    try {
      return source_->Take(n_samples);
    } catch (const DeviceFault&) {
      watch_.Forget();  // the card may come back with its clock at zero
      throw;
    }
  }

  void CompareClocks(std::int64_t card_ns, Time start, int n_samples) {
    const Duration length = FromSeconds(n_samples / actual_.actual.scan_rate_Hz);
    watch_.Compare(card_ns, start, std::max(clock_.Now() - start - length, Duration(0)));
  }

  /// Number of a block's first scan since the first block: by the card's clock where every scan is stamped, so that
  /// those between blocks count; otherwise only those that were taken count. A bench that starts again counts anew.
  std::int64_t CountScans(std::int64_t card_ns, int n_samples) {
    if (card_ns < 0) return std::exchange(scans_, scans_ + n_samples);
    if (origin_ns_ < 0 || card_ns < origin_ns_) origin_ns_ = card_ns;
    return std::llround(static_cast<double>(card_ns - origin_ns_) * 1e-9 * actual_.actual.scan_rate_Hz);
  }

  std::vector<std::int16_t> InChannelOrder(std::vector<std::int16_t> scanned) const {
    std::vector<std::int16_t> raw(scanned.size());
    for (std::size_t scan = 0; scan + kChannels <= raw.size(); scan += kChannels) {
      for (std::size_t place = 0; place < kChannels; ++place) raw[scan + order_[place]] = scanned[scan + place];
    }
    return raw;
  }

  ChannelBlock StatisticsOfChannel(const Acquisition& block, std::size_t channel) const {
    if (!actual_.calibrated)
      return StatisticsOf(MomentsOf(block.raw, kChannels, static_cast<int>(channel)), lsb_V_);
    const auto place = std::find(order_.begin(), order_.end(), channel) - order_.begin();
    return CalibratedStatistics(block.raw, channel, actual_.calibration[static_cast<std::size_t>(place)]);
  }

  void Judge(Acquisition& block, int n_samples) {
    found_ = CheckBlock(block.raw, checks_);
    ThrowIfSpoiled(found_, checks_.noise_lsb);
    for (std::size_t k = 0; k < kChannels; ++k) mains_V_[k] = std::fmax(mains_V_[k], lsb_V_ * found_.mains_lsb[k]);
    block.n_samples = n_samples;
    block.saturated_mask = found_.saturated_mask;
    for (std::size_t k = 0; k < kChannels; ++k) {
      block.channel[k] = StatisticsOfChannel(block, k);
      if ((found_.saturated_mask >> k & 1) == 0) continue;
      block.status = ReadingStatus::kSaturated;  // clipped samples are not averaged
      block.channel[k].mean_V = block.channel[k].std_V = kNaN;
    }
  }

  std::unique_ptr<AdSource> source_;
  const Clock& clock_;
  std::array<std::size_t, kChannels> order_;  // channel of each place in the scan
  double lsb_V_ = kNaN;
  Negotiated actual_;
  CheckSettings checks_;
  BlockFindings found_;
  std::array<double, kChannels> mains_V_ = {kNaN, kNaN, kNaN, kNaN};
  ClockWatch watch_;
  std::int64_t origin_ns_ = -1;  // of the card's clock, at the first block
  std::int64_t scans_ = 0;       // taken
};

}  // namespace

std::unique_ptr<AdFrontEnd> MakeAdConverter(std::unique_ptr<AdSource> source, const AdSettings& settings,
                                            const AdcSettings& scenario_adc, const Clock& clock, double noise_V) {
  return std::make_unique<CardConverter>(std::move(source), settings, scenario_adc, clock, noise_V);
}

std::unique_ptr<AdFrontEnd> MakeAdConverter(const AdSettings& settings, const AdcSettings& scenario_adc,
                                            const Clock& clock, double noise_V) {
  return MakeAdConverter(MakeAdSource(settings), settings, scenario_adc, clock, noise_V);
}

}  // namespace twinbench::hw
