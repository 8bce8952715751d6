#include "hw_bridge/serve/scan_stream.h"

#include <algorithm>
#include <cmath>

namespace twinbench::hw {
namespace {

constexpr double kKept_s = 1.0;

}  // namespace

const char* LightOf(ReadingStatus status) {
  if (status == ReadingStatus::kNoLight) return "no_light";
  return status == ReadingStatus::kClippedSpot ? "clipped_spot" : "ok";
}

ScanStream::ScanStream(AdConverter& adc, Clock& clock, const AdcSettings& settings, int block_scans)
    : adc_(adc),
      clock_(clock),
      rate_Hz_(settings.rate_Hz),
      block_scans_(block_scans),
      kept_scans_(std::max<std::int64_t>(std::llround(kKept_s * rate_Hz_ / kChannels), 4 * block_scans)) {}

Duration ScanStream::TimeOf(std::int64_t scans) const {
  return Duration(std::llround(static_cast<double>(scans) * 1e9 * kChannels / rate_Hz_));
}

/// Amplifiers at rest (zeros) where the bench has no counts: without light, and after its FIFO ran full.
ScanBlock ScanStream::Stamped(Acquisition taken, int scans) {
  light_ = LightOf(taken.status);
  ScanBlock block{std::move(taken.raw), {}};
  block.raw.resize(static_cast<std::size_t>(scans) * kChannels);
  const std::int64_t start_ns = taken.start.time_since_epoch().count();
  const int lost_from = taken.status == ReadingStatus::kOverrun ? taken.n_samples : scans;
  const std::int64_t lost = scans - lost_from;
  overruns_ += lost;
  block.stamps_ns.reserve(static_cast<std::size_t>(scans));
  for (int s = 0; s < scans; ++s) {
    block.stamps_ns.push_back(start_ns + TimeOf(s < lost_from ? s : s + lost).count());
  }
  return block;
}

ScanBlock ScanStream::TakeOne(int scans) {
  return Stamped(adc_.Acquire(scans, true), scans);
}

void ScanStream::TakeNext() {
  held_.push_back({next_scan_, TakeOne(block_scans_)});
  next_scan_ += block_scans_;
  while (next_scan_ - held_.front().first_scan > kept_scans_) held_.pop_front();
}

void ScanStream::Miss(Duration duration) {
  clock_.Wait(duration);
  next_scan_ += std::llround(ToSeconds(duration) * rate_Hz_ / kChannels);
  held_.clear();
}

void ScanStream::Read(std::int64_t& cursor, std::size_t scans, ScanBlock& block) {
  for (const Held& held : held_) {
    if (block.scans() == scans) return;
    const std::int64_t end = held.first_scan + static_cast<std::int64_t>(held.block.scans());
    if (cursor >= end) continue;
    if (cursor < held.first_scan) {
      overruns_ += held.first_scan - cursor;
      cursor = held.first_scan;
    }
    const auto from = static_cast<std::size_t>(cursor - held.first_scan);
    const std::size_t n = std::min(scans - block.scans(), held.block.scans() - from);
    const auto raw = held.block.raw.begin() + static_cast<long>(from * kChannels);
    block.raw.insert(block.raw.end(), raw, raw + static_cast<long>(n * kChannels));
    const auto stamps = held.block.stamps_ns.begin() + static_cast<long>(from);
    block.stamps_ns.insert(block.stamps_ns.end(), stamps, stamps + static_cast<long>(n));
    cursor += static_cast<std::int64_t>(n);
  }
}

}  // namespace twinbench::hw
