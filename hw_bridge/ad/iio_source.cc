#include "hw_bridge/ad/iio_source.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "hw_bridge/ad/backoff.h"
#include "hw_bridge/ad/host_stamp.h"
#include "hw_bridge/ad/iio_block.h"
#include "hw_bridge/ad/iio_context.h"
#include "hw_bridge/ad/scan_stamps.h"
#include "twin/core/number_text.h"

namespace twinbench::hw {
namespace {

constexpr const char* kRate = "sampling_frequency";

std::string OrEmpty(const std::optional<std::string>& text) {
  return text.value_or("");
}

class IioSource : public AdSource {
 public:
  explicit IioSource(const AdSettings& settings) : settings_(settings) {}

  Negotiated Configure(const ScanSpec& spec) override {
    asked_ = spec;
    context_.reset();
    negotiated_ = Open();
    return negotiated_;
  }

  AdBlock Take(int scans) override {
    try {
      if (!context_) Reopen();
      return TakeOpen(scans);
    } catch (const DeviceFault&) {
      context_.reset();  // a late answer has nowhere to arrive
      throw;
    }
  }

 private:
  Negotiated Open();
  void Reopen();
  AdBlock TakeOpen(int scans);
  void FindChannels();
  iio_channel* FindChannel(const std::string& id) const;
  double SettleRate() const;
  double RateOf() const;
  Negotiated Ask() const;
  CalibrationPolynomial NominalOf(const iio_channel* channel) const;
  void SetTimeout(Duration deadline);
  void JudgeGaps(const IioBlock& block) const;
  std::string Light() const;

  AdSettings settings_;
  ScanSpec asked_;
  Negotiated negotiated_;
  Backoff backoff_;
  IioContext context_;
  IioChannels open_;
  unsigned timeout_ms_ = 0;
};

// --- opening ---

Negotiated IioSource::Open() {
  backoff_.BeforeAttempt();
  IioContext context = OpenIioContext(settings_.uri, asked_.deadline);
  context_ = std::move(context);
  timeout_ms_ = 0;
  try {
    SetTimeout(asked_.deadline);
    FindChannels();
    SettleRate();
    const Negotiated answer = Ask();
    backoff_.Succeeded();
    return answer;
  } catch (const DeviceFault&) {
    context_.reset();
    throw;
  }
}

/// The card that answers now must be the one that was configured.
void IioSource::Reopen() {
  const Negotiated now = Open();
  const bool same = now.identity == negotiated_.identity && now.serial == negotiated_.serial &&
                    now.actual.scan_rate_Hz == negotiated_.actual.scan_rate_Hz && now.bits == negotiated_.bits;
  if (same) return;
  throw DeviceFault(FaultKind::kIdentity, open_.name,
                    "was \"" + negotiated_.identity + "\" " + negotiated_.serial + ", opened again it is \"" +
                        now.identity + "\" " + now.serial + " or has another rate or resolution");
}

void IioSource::SetTimeout(Duration deadline) {
  // libiio tells the server half of it, and the server must not give up before us.
  const auto ms = static_cast<unsigned>(std::max(2.0, std::ceil(2e3 * ToSeconds(deadline))));
  if (ms == timeout_ms_) return;
  const int error = iio_context_set_timeout(context_.get(), ms);
  if (error < 0 && error != -ENOSYS) ThrowErrno(settings_.uri, "setting the timeout", -error);
  timeout_ms_ = ms;
}

iio_channel* IioSource::FindChannel(const std::string& id) const {
  iio_channel* channel = iio_device_find_channel(open_.device, id.c_str(), false);
  if (channel != nullptr && iio_channel_is_scan_element(channel)) return channel;
  throw DeviceFault(FaultKind::kRefused, open_.name, "has no input channel \"" + id + "\" that can be buffered");
}

void IioSource::FindChannels() {
  open_ = {};
  open_.device = iio_context_find_device(context_.get(), settings_.device.c_str());
  if (open_.device == nullptr) {
    throw DeviceFault(FaultKind::kIdentity, settings_.uri, "has no device \"" + settings_.device + "\"");
  }
  open_.name = settings_.device;
  for (unsigned k = 0; k < iio_device_get_channels_count(open_.device); ++k) {
    iio_channel_disable(iio_device_get_channel(open_.device, k));
  }
  for (const ScanChannel& channel : asked_.channels) open_.channels.push_back(FindChannel(channel.id));
  for (iio_channel* channel : open_.channels) iio_channel_enable(channel);
  open_.timestamp = iio_device_find_channel(open_.device, "timestamp", false);
  if (open_.timestamp != nullptr) iio_channel_enable(open_.timestamp);
}

double IioSource::RateOf() const {
  if (const auto rate = DeviceNumber(open_.device, kRate)) return *rate;
  if (const auto rate = ChannelNumber(open_.channels.front(), kRate)) return *rate;
  throw DeviceFault(FaultKind::kRefused, open_.name, std::string("has no attribute ") + kRate);
}

/// Asks for the rate if it is another one. Whether what comes out will do is for the caller to judge.
double IioSource::SettleRate() const {
  const double rate_Hz = RateOf();
  if (rate_Hz == asked_.scan_rate_Hz) return rate_Hz;
  const std::string text = PrintInUnit(asked_.scan_rate_Hz, 1.0);
  if (iio_device_attr_write(open_.device, kRate, text.c_str()) < 0) return rate_Hz;  // it cannot be set: see docs
  return RateOf();
}

CalibrationPolynomial IioSource::NominalOf(const iio_channel* channel) const {
  const auto scale_mV = ChannelNumber(channel, "scale");
  if (!scale_mV) throw DeviceFault(FaultKind::kRefused, iio_channel_get_id(channel), "has no attribute scale");
  const iio_data_format& format = *iio_channel_get_data_format(channel);
  const double middle = format.is_signed ? 0.0 : std::ldexp(1.0, static_cast<int>(format.bits) - 1);
  const double offset = middle + ChannelNumber(channel, "offset").value_or(0.0);
  return {0.0, {offset * *scale_mV * 1e-3, *scale_mV * 1e-3}};
}

Negotiated IioSource::Ask() const {
  Negotiated n;
  n.actual = asked_;
  n.actual.scan_rate_Hz = RateOf();
  const int sample_bits = BitsOf(open_.channels.front());
  // Samples may be wider than codes, and some devices say so.
  n.bits = static_cast<int>(DeviceNumber(open_.device, "bits").value_or(sample_bits));
  const double conversions_Hz = DeviceNumber(open_.device, "conversion_frequency").value_or(0.0);
  for (std::size_t k = 0; k < open_.channels.size(); ++k) {
    const iio_channel* channel = open_.channels[k];
    if (BitsOf(channel) != sample_bits || n.bits < 2 || n.bits > sample_bits) {
      throw DeviceFault(FaultKind::kRefused, iio_channel_get_id(channel),
                        "codes of other than 2 to 16 bits, or not the same number on every channel");
    }
    n.calibration.push_back(NominalOf(channel));
    n.actual.channels[k].range_V = n.calibration[k].coefficients_V[1] * std::ldexp(1.0, n.bits - 1);
    n.skew_s.push_back(conversions_Hz > 0.0 ? static_cast<double>(k) / conversions_Hz : 0.0);
  }
  const char* description = iio_context_get_description(context_.get());
  n.identity = open_.name + ", " + (description != nullptr ? description : "");
  n.serial = OrEmpty(DeviceText(open_.device, "serial"));
  if (n.serial.empty()) n.serial = OrEmpty(ContextText(context_.get(), "hw_serial"));
  n.firmware = OrEmpty(ContextText(context_.get(), "fw_version"));
  n.stamps_scans = open_.timestamp != nullptr;
  return n;
}

// --- taking blocks ---

void IioSource::JudgeGaps(const IioBlock& block) const {
  const StampFindings found = JudgeStamps(block.stamps_ns, negotiated_.actual.scan_rate_Hz);
  if (found.first_back >= 0) {
    throw DeviceFault(
        FaultKind::kClock, open_.name,
        "the time stamp of scan " + std::to_string(found.first_back) + " is not later than the one before");
  }
  if (found.lost_scans > 0) {
    throw DeviceFault(FaultKind::kGap, open_.name,
                      std::to_string(found.lost_scans) + " scans are missing, first in front of scan " +
                          std::to_string(found.first_gap));
  }
}

std::string IioSource::Light() const {
  if (settings_.light.empty()) return "ok";
  const auto light = DeviceText(open_.device, settings_.light);
  if (light == "ok" || light == "no_light" || light == "clipped_spot") return *light;
  throw DeviceFault(
      FaultKind::kProtocol, open_.name,
      settings_.light + " is \"" + light.value_or("missing") + "\", not ok, no_light or clipped_spot");
}

AdBlock IioSource::TakeOpen(int scans) {
  const Duration deadline = FromSeconds(scans / negotiated_.actual.scan_rate_Hz) + asked_.deadline;
  SetTimeout(deadline);
  AdBlock block;
  block.stamp = HostStamp();
  IioBlock taken = TakeIioBlock(open_, scans, deadline);
  JudgeGaps(taken);
  block.raw = std::move(taken.raw);
  if (!taken.stamps_ns.empty()) block.stamp.device_ns = taken.stamps_ns.front();
  block.light = Light();
  return block;
}

}  // namespace

std::unique_ptr<AdSource> MakeIioSource(const AdSettings& settings) {
  return std::make_unique<IioSource>(settings);
}

}  // namespace twinbench::hw
