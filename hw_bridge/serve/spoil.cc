#include "hw_bridge/serve/spoil.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "twin/core/units.h"

namespace twinbench::hw {
namespace {

constexpr std::size_t kSaturated = 0, kFloating = 1, kStuckOne = 2;  // channels
constexpr double kHum_Hz = 50.0, kHum_V = 0.1;
constexpr std::int64_t kStep_ns = 1'000'000'000;
constexpr double kFast = 50e-6;

struct Codes {
  explicit Codes(const AdcSettings& adc)
      : highest((1 << (adc.bits - 1)) - 1), per_V(static_cast<double>(1 << (adc.bits - 1)) / adc.range_V) {}
  int highest;
  double per_V;
  std::int16_t Within(double code) const {
    return static_cast<std::int16_t>(std::clamp(std::nearbyint(code), -1.0 - highest, double(highest)));
  }
};

double HumAt(std::int64_t stamp_ns) {
  return std::sin(2.0 * units::kPi * kHum_Hz * static_cast<double>(stamp_ns % kStep_ns) * 1e-9);
}

/// The second half sits on the rail.
void Saturate(ScanBlock& block, const Codes& codes) {
  for (std::size_t s = block.scans() / 2; s < block.scans(); ++s) {
    block.raw[s * kChannels + kSaturated] = static_cast<std::int16_t>(codes.highest);
  }
}

/// An open input: it charges up towards the rail and picks up the mains.
void Float(ScanBlock& block, const Codes& codes) {
  for (std::size_t s = 0; s < block.scans(); ++s) {
    const double drift = 0.02 * static_cast<double>(s) / static_cast<double>(block.scans());
    const double level = 0.92 + drift + 0.05 * HumAt(block.stamps_ns[s]);
    block.raw[s * kChannels + kFloating] = codes.Within(level * codes.highest);
  }
}

void Stick(ScanBlock& block) {
  for (std::size_t s = 1; s < block.scans(); ++s) block.raw[s * kChannels + kStuckOne] = block.raw[kStuckOne];
}

void AddHum(ScanBlock& block, const Codes& codes) {
  for (std::size_t k = 0; k < block.raw.size(); ++k) {
    block.raw[k] = codes.Within(block.raw[k] + kHum_V * codes.per_V * HumAt(block.stamps_ns[k / kChannels]));
  }
}

/// A word is lost in the middle: every channel after it shows the next one.
void Slip(ScanBlock& block) {
  const auto from = block.raw.begin() + static_cast<long>(block.scans() / 2 * kChannels);
  if (from == block.raw.end()) return;
  std::rotate(from, from + 1, block.raw.end());
}

void Skip(ScanBlock& block) {
  if (block.scans() < 2) return;
  const std::int64_t scan_ns = block.stamps_ns[1] - block.stamps_ns[0];
  for (std::size_t s = block.scans() / 2; s < block.scans(); ++s) block.stamps_ns[s] += kGapScans * scan_ns;
}

}  // namespace

void Spoil(ScanBlock& block, Injected fault, const AdcSettings& adc) {
  const Codes codes(adc);
  if (fault == Injected::kSaturate) Saturate(block, codes);
  if (fault == Injected::kFloat) Float(block, codes);
  if (fault == Injected::kStuck) Stick(block);
  if (fault == Injected::kHum) AddHum(block, codes);
  if (fault == Injected::kSlip) Slip(block);
  if (fault == Injected::kGap) Skip(block);
  if (fault == Injected::kNoLight) std::ranges::fill(block.raw, std::int16_t{0});
}

void SpoilStamps(ScanBlock& block, Injected fault) {
  for (std::int64_t& stamp_ns : block.stamps_ns) {
    if (fault == Injected::kStep) stamp_ns += kStep_ns;
    if (fault == Injected::kPpm) stamp_ns += std::llround(static_cast<double>(stamp_ns) * kFast);
  }
}

}  // namespace twinbench::hw
