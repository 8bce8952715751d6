#include "twin/sim/ad_sampler_kernel.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <limits>

#include "twin/core/errors.h"

namespace twinbench::sim {
namespace {

constexpr int kLanes = 16;  // four scans side by side: lane l is channel l mod 4

/// What the four channels have, once per lane.
template <class T>
void ForEachLane(T (&lanes)[kLanes]) {
  std::copy_n(lanes, kChannels, lanes + kChannels);
  std::copy_n(lanes, 2 * kChannels, lanes + 2 * kChannels);
}

/// The quantiser's constants.
struct Lanes {
  explicit Lanes(const Quantiser& quantiser) {
    for (std::size_t k = 0; k < kChannels; ++k) {
      const QuantiserChannel& c = quantiser.channel[k];
      noise[k] = c.noise;
      noise_before[k] = c.noise_before;
      step_at[k] = c.step_at;
      step[k] = c.step;
      base[k] = c.base;
      lowest[k] = static_cast<float>(quantiser.lowest - c.base);
      highest[k] = static_cast<float>(quantiser.highest - c.base);
      is_plain = is_plain && c.noise_before == 0.0f && c.step == 0.0f;
    }
    for (auto* constants : {&noise, &noise_before, &step_at, &step, &lowest, &highest}) ForEachLane(*constants);
    ForEachLane(base);
  }
  float noise[kLanes], noise_before[kLanes], step_at[kLanes], step[kLanes];
  float lowest[kLanes], highest[kLanes];  // end codes less the base: whole numbers
  std::int32_t base[kLanes];
  bool is_plain = true;  // neither crosstalk nor step
};

/// Nearest integer, ties to even, for |x| < 2^22: adding 1.5 * 2^23 leaves no room for a fraction.
[[gnu::always_inline]] inline std::int32_t ToNearest(float x) {
  return std::bit_cast<std::int32_t>(x + 12582912.0f) - 0x4B400000;
}

/// Code less the base.
template <bool kIsPlain>
[[gnu::always_inline]] inline std::int32_t DeviationOf(const Lanes& lanes, std::size_t l, float signal, float before,
                                                       float normal) {
  float x = signal + lanes.noise[l] * normal;
  if constexpr (!kIsPlain) {
    x += lanes.noise_before[l] * before;
    x += x >= lanes.step_at[l] ? lanes.step[l] : 0.0f;
  }
  x = x > lanes.highest[l] ? lanes.highest[l] : x;
  x = x < lanes.lowest[l] ? lanes.lowest[l] : x;
  return ToNearest(x);
}

/// Sums of one lane each; 64 terms of up to 2^16 (deviation) fit into 32 bits, their squares need 64.
struct LaneSums {
  std::int32_t deviation[kLanes]{};
  std::int64_t square[kLanes]{};
  std::int32_t lowest[kLanes], highest[kLanes];  // deviations
};

struct Work {
  const Lanes& lanes;
  std::size_t n;  // multiple of kLanes, not 0
  const float* signal;
  const float* normals;
  std::int32_t* codes;  // null where nobody wants them
};

/// The sums alone, with squares of 32 bits: wrong if a deviation is beyond kNarrow.
template <bool kIsPlain>
[[gnu::always_inline]] inline void NarrowLoop(const Lanes& lanes, std::size_t n, const float* __restrict signal,
                                              const float* __restrict normals, LaneSums& sums) {
  std::int32_t deviation[kLanes]{}, lowest[kLanes], highest[kLanes];
  std::uint32_t square[kLanes]{};
  std::fill_n(lowest, kLanes, std::numeric_limits<std::int32_t>::max());
  std::fill_n(highest, kLanes, std::numeric_limits<std::int32_t>::min());
  for (std::size_t i = 0; i < n; i += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) {
      const std::int32_t d =
          DeviationOf<kIsPlain>(lanes, l, signal[i + l], normals[i + l + 3], normals[i + l + 4]);
      deviation[l] += d;
      square[l] += static_cast<std::uint32_t>(d) * static_cast<std::uint32_t>(d);
      lowest[l] = d < lowest[l] ? d : lowest[l];
      highest[l] = d > highest[l] ? d : highest[l];
    }
  }
  for (std::size_t l = 0; l < kLanes; ++l) {
    sums.deviation[l] = deviation[l];
    sums.square[l] = square[l];
    sums.lowest[l] = lowest[l];
    sums.highest[l] = highest[l];
  }
}

bool IsNarrow(const LaneSums& sums) {
  constexpr std::int32_t kNarrow = 5792;  // 64 * 5792^2 < 2^31
  int wide = 0;
  for (std::size_t l = 0; l < kLanes; ++l) wide |= (sums.lowest[l] < -kNarrow) | (sums.highest[l] > kNarrow);
  return wide == 0;
}

[[gnu::always_inline]] inline void ConvertLoop(const Lanes& lanes, std::size_t n, const float* __restrict signal,
                                               const float* __restrict normals, std::int32_t* __restrict codes) {
  for (std::size_t i = 0; i < n; i += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) {
      codes[i + l] =
          lanes.base[l] + DeviationOf<false>(lanes, l, signal[i + l], normals[i + l + 3], normals[i + l + 4]);
    }
  }
}

[[gnu::always_inline]] inline void WideLoop(const Lanes& lanes, std::size_t n, const std::int32_t* __restrict codes,
                                            LaneSums& sums) {
  sums = {};
  for (std::size_t l = 0; l < kLanes; ++l) sums.lowest[l] = sums.highest[l] = codes[l] - lanes.base[l];
  for (std::size_t i = 0; i < n; i += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) {
      const std::int32_t d = codes[i + l] - lanes.base[l];
      sums.deviation[l] += d;
      sums.square[l] += std::int64_t{d} * d;
      sums.lowest[l] = d < sums.lowest[l] ? d : sums.lowest[l];
      sums.highest[l] = d > sums.highest[l] ? d : sums.highest[l];
    }
  }
}

[[gnu::always_inline]] inline void QuantiseLoop(const Work& work, LaneSums& sums) {
  std::int32_t unwanted[kChunk];
  if (work.codes == nullptr) {
    if (work.lanes.is_plain) {
      NarrowLoop<true>(work.lanes, work.n, work.signal, work.normals, sums);
    } else {
      NarrowLoop<false>(work.lanes, work.n, work.signal, work.normals, sums);
    }
    if (IsNarrow(sums)) return;
  }
  std::int32_t* const codes = work.codes == nullptr ? unwanted : work.codes;
  ConvertLoop(work.lanes, work.n, work.signal, work.normals, codes);
  WideLoop(work.lanes, work.n, codes, sums);
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

void AddLanes(const Lanes& lanes, const LaneSums& lane_sums, CodeSums& sums) {
  for (std::size_t l = 0; l < kLanes; ++l) {
    const std::size_t k = l % kChannels;
    sums.deviation[k] += lane_sums.deviation[l];
    sums.square[k] += lane_sums.square[l];
    sums.lowest[k] = std::min(sums.lowest[k], lanes.base[l] + lane_sums.lowest[l]);
    sums.highest[k] = std::max(sums.highest[k], lanes.base[l] + lane_sums.highest[l]);
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
  Require(normals.size() == signal.size() + 4, "a chunk's arrays belong together");
  Require(codes.empty() || codes.size() == signal.size(), "a chunk's arrays belong together");
  Require(SimdRuns(simd), "this processor does not run the chosen instruction set");
  const Lanes lanes(quantiser);
  const std::size_t n = signal.size() / kLanes * kLanes;
  if (n > 0) {
    LaneSums lane_sums;
    QuantiseLanes(simd, {lanes, n, signal.data(), normals.data(), codes.empty() ? nullptr : codes.data()},
                  lane_sums);
    AddLanes(lanes, lane_sums, sums);
  }
  for (std::size_t i = n; i < signal.size(); ++i) {
    const std::int64_t deviation =
        DeviationOf<false>(lanes, i % kLanes, signal[i], normals[i + 3], normals[i + 4]);
    const auto code = static_cast<std::int32_t>(lanes.base[i % kLanes] + deviation);
    if (!codes.empty()) codes[i] = code;
    AddCode(i % kChannels, code, deviation, deviation * deviation, sums);
  }
}

}  // namespace twinbench::sim
