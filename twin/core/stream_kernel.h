#pragma once

#include <array>
#include <cstdint>
#include <span>

/// Random words and normals of class Stream, without its bookkeeping.
///
/// Reference: J. K. Salmon et al., Parallel random numbers: as easy as 1, 2, 3, SC'11 (Philox4x32-10).
namespace twinbench {

/// Instruction sets that the vectorised kernels are compiled for. All give the same bits.
enum class Simd { kBaseline, kAvx2, kAvx512 };
inline constexpr std::array<Simd, 3> kAllSimd = {Simd::kBaseline, Simd::kAvx2, Simd::kAvx512};
const char* SimdName(Simd simd);  // "baseline", "avx2", "avx512"

/// @return whether this processor can run the variant.
bool SimdRuns(Simd simd);
Simd BestSimd();

using PhiloxKey = std::array<std::uint32_t, 2>;
using PhiloxBlock = std::array<std::uint32_t, 4>;

/// Ten rounds of Philox4x32 on an arbitrary counter.
PhiloxBlock Philox(const PhiloxBlock& counter, const PhiloxKey& key);

/// Writes four standard normals a block for the counters (block, 0), (block + 1, 0), ...: out[4 i + j] comes from
/// block + i alone. Words 0, 1 make the first pair, words 2, 3 the second (Box-Muller in float).
///
/// Accuracy against the same transform in exact arithmetic: 1e-6 + 6e-8 / r absolute, where r is the pair's radius
/// (u = exp(-r^2 / 2) is rounded to a float); the largest value is 6.66.
/// @throws std::logic_error unless the size of `out` is a multiple of 4 and the processor runs `simd`.
void FillNormalBlocks(Simd simd, const PhiloxKey& key, std::uint64_t block, std::span<float> out);

}  // namespace twinbench
