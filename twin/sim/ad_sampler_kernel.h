#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "twin/core/reading.h"
#include "twin/core/stream_kernel.h"

/// The inner loop of the A/D converter, in units of its codes. Private to the converter and its tests.
namespace twinbench::sim {

inline constexpr int kChunkScans = 256;
inline constexpr int kChunk = kChunkScans * kChannels;  // conversions handled at a time, so that they stay in cache

/// How deviations from a channel's base code become codes; everything counts in LSB.
struct QuantiserChannel {
  float noise = 0.0f;         // standard deviation of the white noise
  float noise_before = 0.0f;  // crosstalk times the noise of the channel converted before
  float step_at = 0.0f;       // threshold - base code
  float step = 0.0f;
  std::int32_t base = 0;  // whole code near the level: floats hold only the distance from it
};

struct Quantiser {
  std::array<QuantiserChannel, kChannels> channel;
  std::int32_t lowest = 0, highest = 0;  // end codes
};

/// Integers, so that the order of summation does not matter. Deviations are code - base.
struct CodeSums {
  std::array<std::int64_t, kChannels> deviation{};
  std::array<std::int64_t, kChannels> square{};
  std::array<std::int32_t, kChannels> lowest;   // code
  std::array<std::int32_t, kChannels> highest;  // code
  CodeSums();
};

/// @param deviation, square  Of the code from the channel's base.
void AddCode(std::size_t channel, std::int32_t code, std::int64_t deviation, std::int64_t square, CodeSums& sums);

/// Quantises conversions and adds them to `sums`.
///
/// @param signal   Noise-free deviation from the base code [LSB]; whole scans, at most kChunk.
/// @param normals  Four more than `signal`: conversion i has normals[i + 4], the one before it normals[i + 3].
/// @param codes    Out, as long as `signal`; or empty where the sums are all that is wanted: quicker.
void Quantise(Simd simd, const Quantiser& quantiser, std::span<const float> signal, std::span<const float> normals,
              std::span<std::int32_t> codes, CodeSums& sums);

}  // namespace twinbench::sim
