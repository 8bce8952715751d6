#include "hw_bridge/ad/negotiation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/device_fault.h"
#include "twin/core/number_text.h"

namespace twinbench::hw {
namespace {

/// Drivers print scales with some nine digits.
constexpr double kRangeTolerance = 1e-6;

std::string Text(double value) {
  return PrintInUnit(value, 1.0);
}

[[noreturn]] void Refuse(const Negotiated& actual, const std::string& what, const std::string& card,
                         const std::string& scenario) {
  throw DeviceFault(FaultKind::kRefused, actual.identity,
                    "the card's " + what + " is " + card + ", the scenario asks for " + scenario);
}

bool Agree(double a, double b, double tolerance) {
  return std::abs(a - b) <= tolerance * std::abs(b);
}

void RequireNominal(const Negotiated& actual, std::size_t k, const AdcSettings& adc) {
  const double lsb_V = std::ldexp(adc.range_V, 1 - adc.bits), range_V = actual.actual.channels[k].range_V;
  if (!Agree(range_V, adc.range_V, kRangeTolerance)) {
    Refuse(actual, "range", "±" + Text(range_V) + " V", "±" + Text(adc.range_V) + " V");
  }
  const double zero_V = actual.calibration[k].coefficients_V.at(0);
  if (std::abs(zero_V) > 0.01 * lsb_V) Refuse(actual, "voltage at code 0", Text(zero_V) + " V", "0 V");
}

void RequireSerial(const Negotiated& actual, const AdSettings& settings) {
  if (settings.serial.empty() || settings.serial == actual.serial) return;
  const std::string told = actual.serial.empty() ? "its driver tells none" : "it is " + actual.serial;
  throw DeviceFault(FaultKind::kIdentity, actual.identity,
                    "serial number " + settings.serial + " is expected, " + told);
}

}  // namespace

std::array<std::size_t, kChannels> ScanOrderOf(const AdcSettings& adc) {
  std::array<std::size_t, kChannels> order{};
  Require(adc.scan_list.size() == kChannels, "the scan list names every channel once");
  for (std::size_t place = 0; place < kChannels; ++place) {
    const auto found = std::find(kChannelNames.begin(), kChannelNames.end(), adc.scan_list[place]);
    Require(found != kChannelNames.end(), "the scan list names a channel that does not exist");
    order[place] = static_cast<std::size_t>(found - kChannelNames.begin());
  }
  return order;
}

ScanSpec SpecOf(const AdSettings& settings, const AdcSettings& adc) {
  Require(settings.channels.size() == kChannels, "a bench file names the card's channel of every channel");
  ScanSpec spec;
  for (const std::size_t channel : ScanOrderOf(adc)) {
    spec.channels.push_back({settings.channels[channel], adc.range_V, settings.reference});
  }
  spec.scan_rate_Hz = adc.rate_Hz / kChannels;
  spec.deadline = FromSeconds(settings.timeout_s);
  return spec;
}

void RequireAsAsked(const Negotiated& actual, const AdSettings& settings, const AdcSettings& adc) {
  RequireSerial(actual, settings);
  const double asked_Hz = adc.rate_Hz / kChannels;
  if (!Agree(actual.actual.scan_rate_Hz, asked_Hz, settings.rate_tolerance)) {
    Refuse(actual, "rate", Text(actual.actual.scan_rate_Hz) + " scans/s", Text(asked_Hz) + " scans/s");
  }
  if (actual.bits != adc.bits) {
    Refuse(actual, "resolution", std::to_string(actual.bits) + " bits", std::to_string(adc.bits) + " bits");
  }
  for (std::size_t k = 0; k < kChannels && !actual.calibrated; ++k) RequireNominal(actual, k, adc);
}

std::string Describe(const Negotiated& actual) {
  std::string text = actual.identity;
  if (!actual.serial.empty()) text += ", serial " + actual.serial;
  if (!actual.firmware.empty()) text += ", " + actual.firmware;
  text += ", " + Text(actual.actual.scan_rate_Hz) + " scans/s, " + std::to_string(actual.bits) + " bits, ±" +
          Text(actual.actual.channels.front().range_V) + " V, skew " + Text(actual.skew_s.back()) + " s";
  if (actual.calibrated) text += ", calibrated";
  return text + (actual.stamps_scans ? ", scans stamped" : ", scans not stamped");
}

std::vector<std::string> DescribeChannels(const Negotiated& actual) {
  std::vector<std::string> lines;
  for (std::size_t k = 0; k < actual.actual.channels.size(); ++k) {
    const ScanChannel& channel = actual.actual.channels[k];
    const CalibrationPolynomial& polynomial = actual.calibration[k];
    lines.push_back(fmt::format("{}: ±{} V, {}, {} us behind the first; {} volts = {} in powers of (code - {})",
                                channel.id, channel.range_V, channel.reference, 1e6 * actual.skew_s[k],
                                actual.calibrated ? "calibrated" : "nominal",
                                fmt::join(polynomial.coefficients_V, ", "), polynomial.origin));
  }
  return lines;
}

}  // namespace twinbench::hw
