#include "hw_bridge/serve/iiod_buffer.h"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cstring>

#include "hw_bridge/serve/iiod_devices.h"
#include "hw_bridge/serve/spoil.h"

namespace twinbench::hw {
namespace {

static_assert(std::endian::native == std::endian::little, "samples go out as they are in memory");

constexpr int kBlocksATurn = 64;  // then other clients have theirs

bool Has(std::uint32_t mask, int index) {
  return (mask >> index & 1u) != 0;
}

}  // namespace

std::optional<std::uint32_t> ParseIiodMask(const std::string& hex) {
  std::uint32_t mask = 0;
  const auto [end, error] = std::from_chars(hex.data(), hex.data() + hex.size(), mask, 16);
  if (hex.size() != 8 || error != std::errc() || end != hex.data() + hex.size()) return std::nullopt;
  if (mask == 0 || mask >> (kTimestampIndex + 1) != 0) return std::nullopt;
  return mask;
}

std::string PrintIiodMask(std::uint32_t mask) {
  return fmt::format("{:08x}", mask);
}

std::size_t ScanBytes(std::uint32_t mask) {
  std::size_t bytes = 0;
  for (int k = 0; k < kChannels; ++k) bytes += Has(mask, k) ? sizeof(std::int16_t) : 0;
  if (!Has(mask, kTimestampIndex)) return bytes;
  constexpr std::size_t kStamp = sizeof(std::int64_t);
  return (bytes + kStamp - 1) / kStamp * kStamp + kStamp;
}

IiodBuffer::IiodBuffer(ServedBench& served, std::uint32_t mask) : served_(served), mask_(mask) {
  served_.paced.CatchUp();
  served_.paced.AddReader();
  cursor_ = served_.paced.stream().next_scan();
}

IiodBuffer::~IiodBuffer() {
  Release();
  served_.paced.RemoveReader();
}

bool IiodBuffer::Ask(std::size_t scans) {
  Release();
  if (served_.scans_asked + scans > kMostScansOfAll) return false;
  wanted_ = scans;
  served_.scans_asked += scans;
  return true;
}

void IiodBuffer::Release() {
  block_ = {};
  served_.scans_asked -= wanted_;
  wanted_ = 0;
}

bool IiodBuffer::Collect() {
  PacedBench& paced = served_.paced;
  paced.CatchUp();
  if (paced.Held()) {
    paced.Spend([&] { block_ = paced.stream().TakeOne(static_cast<int>(wanted_)); });
    return true;
  }
  paced.stream().Read(cursor_, wanted_, block_);
  for (int turn = 0; turn < kBlocksATurn && paced.Timeless() && block_.scans() < wanted_; ++turn) {
    paced.Spend([&] { paced.stream().TakeNext(); });
    paced.stream().Read(cursor_, wanted_, block_);
  }
  return block_.scans() == wanted_;
}

Injected IiodBuffer::Suffer() {
  SpoilStamps(block_, served_.faults.TakeStamp());
  const Injected fault = served_.faults.TakeBlock();
  Spoil(block_, fault, served_.adc);
  if (fault == Injected::kNoLight) served_.paced.stream().SetLight("no_light");
  if (fault == Injected::kGap && !served_.paced.Held()) cursor_ += kGapScans;
  return fault;
}

std::string IiodBuffer::Encode(std::size_t first, std::size_t n) const {
  std::string bytes(n * ScanBytes(mask_), '\0');
  char* to = bytes.data();
  for (std::size_t s = first; s < first + n; ++s) {
    char* at = to;
    for (int k = 0; k < kChannels; ++k) {
      if (!Has(mask_, k)) continue;
      std::memcpy(at, &block_.raw[s * kChannels + static_cast<std::size_t>(k)], sizeof(std::int16_t));
      at += sizeof(std::int16_t);
    }
    to += ScanBytes(mask_);
    if (Has(mask_, kTimestampIndex))
      std::memcpy(to - sizeof(std::int64_t), &block_.stamps_ns[s], sizeof(std::int64_t));
  }
  return bytes;
}

}  // namespace twinbench::hw
