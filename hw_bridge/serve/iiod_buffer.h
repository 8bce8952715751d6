#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hw_bridge/serve/served_bench.h"

namespace twinbench::hw {

/// Channels that a client wants: bit k is the scan element with index k.
/// @param hex  8 digits (all channels here fit one word). @return nothing if it is none, empty, or asks for a
/// channel
///             that is not there.
std::optional<std::uint32_t> ParseIiodMask(const std::string& hex);
std::string PrintIiodMask(std::uint32_t mask);
/// Bytes of one scan: 16-bit samples, the 64-bit time stamp last and aligned.
std::size_t ScanBytes(std::uint32_t mask);

/// A buffer that a client has opened on the converter.
class IiodBuffer {
 public:
  static constexpr std::size_t kMostScans = 1u << 20;       // of one block
  static constexpr std::size_t kMostScansOfAll = 4u << 20;  // of all blocks under way

  IiodBuffer(ServedBench& served, std::uint32_t mask);
  ~IiodBuffer();
  IiodBuffer(const IiodBuffer&) = delete;
  IiodBuffer& operator=(const IiodBuffer&) = delete;

  std::uint32_t mask() const { return mask_; }
  /// Begins a block of `scans` scans. @return false if all clients together ask for too much.
  bool Ask(std::size_t scans);
  /// The block has been delivered: its memory is others' again.
  void Release();
  /// Takes what there is; held, the whole block at once. @return whether the block is complete.
  bool Collect();
  /// The fault that strikes the block; `block` has suffered it as far as it is one of the card.
  Injected Suffer();
  /// Scans [first, first + n) of the block as bytes of the wire.
  std::string Encode(std::size_t first, std::size_t n) const;

 private:
  ServedBench& served_;
  std::uint32_t mask_;
  std::int64_t cursor_;
  std::size_t wanted_ = 0;
  ScanBlock block_;
};

}  // namespace twinbench::hw
