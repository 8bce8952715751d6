#include "twin/sim/ad_sampler_kernel.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <limits>

#include "twin/core/errors.h"

namespace twinbench::sim {
namespace {

constexpr int kLanes = 16;  // four scans side by side: lane l is channel l mod 4

/// The quantiser's constants once per lane.
struct Lanes {
  explicit Lanes(const Quantiser& quantiser) : lowest(quantiser.lowest), highest(quantiser.highest) {
    for (std::size_t l = 0; l < kLanes; ++l) {
      const QuantiserChannel& c = quantiser.channel[l % kChannels];
      noise[l] = c.noise;
      noise_before[l] = c.noise_before;
      step_at[l] = c.step_at;
      step[l] = c.step;
      base[l] = c.base;
    }
  }
  float noise[kLanes], noise_before[kLanes], step_at[kLanes], step[kLanes];
  std::int32_t base[kLanes];
  std::int32_t lowest, highest;
};

/// Nearest integer, ties to even, for |x| < 2^22: adding 1.5 * 2^23 leaves no room for a fraction.
[[gnu::always_inline]] inline std::int32_t ToNearest(float x) {
  return std::bit_cast<std::int32_t>(x + 12582912.0f) - 0x4B400000;
}

[[gnu::always_inline]] inline std::int32_t CodeOf(const Lanes& lanes, std::size_t l, float signal, float before,
                                                  float normal) {
  float x = signal + lanes.noise[l] * normal + lanes.noise_before[l] * before;
  x += x >= lanes.step_at[l] ? lanes.step[l] : 0.0f;
  x = x > 262144.0f ? 262144.0f : x;  // beyond any code, within ToNearest
  x = x < -262144.0f ? -262144.0f : x;
  const std::int32_t code = lanes.base[l] + ToNearest(x);
  const std::int32_t held = code > lanes.highest ? lanes.highest : code;
  return held < lanes.lowest ? lanes.lowest : held;
}

[[gnu::always_inline]] inline void ConvertLoop(const Lanes& lanes, std::size_t n, const float* __restrict signal,
                                               const float* __restrict normals, std::int32_t* __restrict codes) {
  for (std::size_t i = 0; i < n; i += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) {
      codes[i + l] = CodeOf(lanes, l, signal[i + l], normals[i + l + 3], normals[i + l + 4]);
    }
  }
}

/// Sums of one lane each; 64 terms of up to 2^16 (deviation) fit into 32 bits, their squares need 64.
struct LaneSums {
  std::int32_t deviation[kLanes]{};
  std::int64_t square[kLanes]{};
  std::int32_t lowest[kLanes], highest[kLanes];
};

[[gnu::always_inline]] inline void SumLoop(const Lanes& lanes, std::size_t n, const std::int32_t* __restrict codes,
                                           LaneSums& sums) {
  for (std::size_t l = 0; l < kLanes; ++l) sums.lowest[l] = sums.highest[l] = codes[l];
  for (std::size_t i = 0; i < n; i += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) {
      const std::int32_t code = codes[i + l], d = code - lanes.base[l];
      sums.deviation[l] += d;
      sums.square[l] += std::int64_t{d} * d;
      sums.lowest[l] = code < sums.lowest[l] ? code : sums.lowest[l];
      sums.highest[l] = code > sums.highest[l] ? code : sums.highest[l];
    }
  }
}

struct Work {
  const Lanes& lanes;
  std::size_t n;  // multiple of kLanes, not 0
  const float* signal;
  const float* normals;
  std::int32_t* codes;
};

[[gnu::always_inline]] inline void QuantiseLoop(const Work& work, LaneSums& sums) {
  ConvertLoop(work.lanes, work.n, work.signal, work.normals, work.codes);
  SumLoop(work.lanes, work.n, work.codes, sums);
}

void QuantiseBaseline(const Work& work, LaneSums& sums) {
  QuantiseLoop(work, sums);
}
[[gnu::target("avx2")]] void QuantiseAvx2(const Work& work, LaneSums& sums) {
  QuantiseLoop(work, sums);
}
#if defined(__GNUC__) && !defined(__clang__)
[[gnu::target("avx512f,avx512bw,avx512dq,avx512vl,prefer-vector-width=512")]]
#else
[[gnu::target("avx512f,avx512bw,avx512dq,avx512vl")]]
#endif
void QuantiseAvx512(const Work& work, LaneSums& sums) {
  QuantiseLoop(work, sums);
}

void QuantiseLanes(Simd simd, const Work& work, LaneSums& sums) {
  switch (simd) {
    case Simd::kBaseline:
      return QuantiseBaseline(work, sums);
    case Simd::kAvx2:
      return QuantiseAvx2(work, sums);
    case Simd::kAvx512:
      return QuantiseAvx512(work, sums);
  }
}

void AddLanes(const LaneSums& lane_sums, CodeSums& sums) {
  for (std::size_t l = 0; l < kLanes; ++l) {
    AddCode(l % kChannels, lane_sums.lowest[l], lane_sums.deviation[l], lane_sums.square[l], sums);
    AddCode(l % kChannels, lane_sums.highest[l], 0, 0, sums);
  }
}

}  // namespace

CodeSums::CodeSums() {
  lowest.fill(std::numeric_limits<std::int32_t>::max());
  highest.fill(std::numeric_limits<std::int32_t>::min());
}

void AddCode(std::size_t channel, std::int32_t code, std::int64_t deviation, std::int64_t square, CodeSums& sums) {
  sums.deviation[channel] += deviation;
  sums.square[channel] += square;
  sums.lowest[channel] = std::min(sums.lowest[channel], code);
  sums.highest[channel] = std::max(sums.highest[channel], code);
}

void Quantise(Simd simd, const Quantiser& quantiser, std::span<const float> signal, std::span<const float> normals,
              std::span<std::int32_t> codes, CodeSums& sums) {
  Require(signal.size() <= kChunk && signal.size() % kChannels == 0, "a chunk is made of whole scans");
  Require(normals.size() == signal.size() + 4 && codes.size() == signal.size(), "a chunk's arrays belong together");
  Require(SimdRuns(simd), "this processor does not run the chosen instruction set");
  const Lanes lanes(quantiser);
  const std::size_t n = signal.size() / kLanes * kLanes;
  if (n > 0) {
    LaneSums lane_sums;
    QuantiseLanes(simd, {lanes, n, signal.data(), normals.data(), codes.data()}, lane_sums);
    AddLanes(lane_sums, sums);
  }
  for (std::size_t i = n; i < signal.size(); ++i) {
    codes[i] = CodeOf(lanes, i % kLanes, signal[i], normals[i + 3], normals[i + 4]);
    const std::int64_t deviation = codes[i] - lanes.base[i % kLanes];
    AddCode(i % kChannels, codes[i], deviation, deviation * deviation, sums);
  }
}

}  // namespace twinbench::sim
