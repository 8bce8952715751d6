#include "twin/core/stream_kernel.h"

#include <bit>
#include <cmath>

#include "twin/core/errors.h"

namespace twinbench {
namespace {

struct Counter {
  std::uint32_t c0, c1, c2, c3;
};

[[gnu::always_inline]] inline Counter Round(Counter c, std::uint32_t k0, std::uint32_t k1) {
  const std::uint64_t a = std::uint64_t{0xD2511F53u} * c.c0;
  const std::uint64_t b = std::uint64_t{0xCD9E8D57u} * c.c2;
  return {static_cast<std::uint32_t>(b >> 32) ^ c.c1 ^ k0, static_cast<std::uint32_t>(b),
          static_cast<std::uint32_t>(a >> 32) ^ c.c3 ^ k1, static_cast<std::uint32_t>(a)};
}

/// Two rounds, the second of which is number `n` (from 1) of the key schedule.
[[gnu::always_inline]] inline Counter TwoRounds(Counter c, std::uint32_t k0, std::uint32_t k1, std::uint32_t n) {
  constexpr std::uint32_t kWeyl0 = 0x9E3779B9u, kWeyl1 = 0xBB67AE85u;
  const Counter half = Round(c, k0 + (n - 1) * kWeyl0, k1 + (n - 1) * kWeyl1);
  return Round(half, k0 + n * kWeyl0, k1 + n * kWeyl1);
}

/// Written out: a loop in here would keep the compilers from vectorising the one around it.
[[gnu::always_inline]] inline Counter TenRounds(Counter c, std::uint32_t k0, std::uint32_t k1) {
  c = TwoRounds(c, k0, k1, 1);
  c = TwoRounds(c, k0, k1, 3);
  c = TwoRounds(c, k0, k1, 5);
  c = TwoRounds(c, k0, k1, 7);
  return TwoRounds(c, k0, k1, 9);
}

/// -2 ln(u) for u = (w / 2 + 1/2) / 2^31. The polynomial is the minimax fit of -2 ln(1 + f) / f on
/// [sqrt(1/2) - 1, sqrt(2) - 1], relative error 2.6e-8 (found with a Remez exchange).
[[gnu::always_inline]] inline float MinusTwoLog(std::uint32_t w) {
  const float u = (static_cast<float>(static_cast<std::int32_t>(w >> 1)) + 0.5f) * 0x1p-31f;
  const auto bits = std::bit_cast<std::int32_t>(u);
  const std::int32_t exponent = (bits - 0x3F3504F3) >> 23;
  const float f = std::bit_cast<float>(bits - exponent * 0x800000) - 1.0f;
  float q = -0.174447194f;
  q = q * f + 0.287336902f;
  q = q * f - 0.299045322f;
  q = q * f + 0.331247855f;
  q = q * f - 0.399136672f;
  q = q * f + 0.500041482f;
  q = q * f - 0.666683713f;
  q = q * f + 0.999999759f;
  q = q * f - 1.999999948f;
  return static_cast<float>(exponent) * -1.38629436f + q * f;
}

struct Pair {
  float x, y;
};

/// A uniform direction: 30 bits choose an angle within +-45 degrees, one bit mirrors it, one swaps the axes.
/// Both polynomials are minimax fits in the square of angle / 45 degrees; absolute errors 2.8e-8 and 2.4e-9.
[[gnu::always_inline]] inline Pair Direction(std::uint32_t w) {
  const float a = static_cast<float>(static_cast<std::int32_t>(w << 2)) * 0x1p-31f;
  const float aa = a * a;
  const float cosine = ((-0.000318880509f * aa + 0.0158499153f) * aa - 0.308424254f) * aa + 0.999999972f;
  const float sine = (((-3.59545078e-5f * aa + 0.00249000713f) * aa - 0.0807454348f) * aa + 0.785398161f) * a;
  const std::uint32_t c = std::bit_cast<std::uint32_t>(cosine) ^ (w & 0x80000000u);
  const std::uint32_t s = std::bit_cast<std::uint32_t>(sine);
  const std::uint32_t swap = (c ^ s) & (0u - ((w >> 30) & 1u));
  return {std::bit_cast<float>(c ^ swap), std::bit_cast<float>(s ^ swap)};
}

[[gnu::always_inline]] inline Pair BoxMuller(std::uint32_t for_radius, std::uint32_t for_angle) {
  const float radius = std::sqrt(MinusTwoLog(for_radius));
  const Pair direction = Direction(for_angle);
  return {radius * direction.x, radius * direction.y};
}

[[gnu::always_inline]] inline void FillLoop(PhiloxKey key, std::uint64_t block, std::size_t n_blocks,
                                            float* __restrict out) {
  const std::uint32_t k0 = key[0], k1 = key[1];
  const auto low = static_cast<std::uint32_t>(block), high = static_cast<std::uint32_t>(block >> 32);
  const auto n = static_cast<std::uint32_t>(n_blocks);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t c0 = low + i;
    const Counter words = TenRounds({c0, high + (c0 < low ? 1u : 0u), 0u, 0u}, k0, k1);
    const Pair first = BoxMuller(words.c0, words.c1);
    const Pair second = BoxMuller(words.c2, words.c3);
    float* const o = out + std::size_t{4} * i;
    o[0] = first.x;
    o[1] = first.y;
    o[2] = second.x;
    o[3] = second.y;
  }
}

void FillBaseline(PhiloxKey key, std::uint64_t block, std::size_t n_blocks, float* out) {
  FillLoop(key, block, n_blocks, out);
}
[[gnu::target("avx2")]] void FillAvx2(PhiloxKey key, std::uint64_t block, std::size_t n_blocks, float* out) {
  FillLoop(key, block, n_blocks, out);
}
#if defined(__GNUC__) && !defined(__clang__)
[[gnu::target("avx512f,avx512bw,avx512dq,avx512vl,prefer-vector-width=512")]]
#else
[[gnu::target("avx512f,avx512bw,avx512dq,avx512vl")]]
#endif
void FillAvx512(PhiloxKey key, std::uint64_t block, std::size_t n_blocks, float* out) {
  FillLoop(key, block, n_blocks, out);
}

}  // namespace

const char* SimdName(Simd simd) {
  switch (simd) {
    case Simd::kBaseline:
      return "baseline";
    case Simd::kAvx2:
      return "avx2";
    default:
      return "avx512";
  }
}

bool SimdRuns(Simd simd) {
  switch (simd) {
    case Simd::kBaseline:
      return true;
    case Simd::kAvx2:
      return __builtin_cpu_supports("avx2") != 0;
    default:
      return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
             __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
  }
}

Simd BestSimd() {
  if (SimdRuns(Simd::kAvx512)) return Simd::kAvx512;
  return SimdRuns(Simd::kAvx2) ? Simd::kAvx2 : Simd::kBaseline;
}

PhiloxBlock Philox(const PhiloxBlock& counter, const PhiloxKey& key) {
  const Counter words = TenRounds({counter[0], counter[1], counter[2], counter[3]}, key[0], key[1]);
  return {words.c0, words.c1, words.c2, words.c3};
}

void FillNormalBlocks(Simd simd, const PhiloxKey& key, std::uint64_t block, std::span<float> out) {
  Require(out.size() % 4 == 0, "normals are made in blocks of four");
  Require(out.size() < (std::size_t{1} << 34), "normals of one call: fewer than 2^32 blocks");
  Require(SimdRuns(simd), "this processor does not run the chosen instruction set");
  switch (simd) {
    case Simd::kBaseline:
      return FillBaseline(key, block, out.size() / 4, out.data());
    case Simd::kAvx2:
      return FillAvx2(key, block, out.size() / 4, out.data());
    case Simd::kAvx512:
      return FillAvx512(key, block, out.size() / 4, out.data());
  }
}

}  // namespace twinbench
