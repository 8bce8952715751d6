#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

/// Exponential and logarithm that a compiler can vectorise in the loop around them, also where there are no
/// conversions between long integers and doubles (AVX2): a number below 2^51 plus 1.5 2^52 has its integer in its last bits.
namespace twinbench::diagnose {

inline constexpr double kLn2High = 0x1.62e42fefa38p-1, kLn2Low = 0x1.ef35793c7673p-45;  // ln 2 in two parts

/// By Horner's rule, highest power first; written out by the compiler, for a loop would keep it from vectorising the one around.
template <class... Coefficients>
[[gnu::always_inline]] inline double Polynomial(double x, double highest, Coefficients... others) {
  double sum = highest;
  ((sum = sum * x + others), ...);
  return sum;
}

/// e^x for x <= 0; below -700 that of -700. Relative error below 1e-14: power series of the remainder after 2^n.
[[gnu::always_inline]] inline double ExpOfNegative(double x) {
  constexpr double kRound = 0x1.8p52, kLog2E = 0x1.71547652b82fep0;
  x = std::max(x, -700.0);
  const double shifted = x * kLog2E + kRound, n = shifted - kRound;
  const double r = (x - n * kLn2High) - n * kLn2Low;
  const double sum = Polynomial(r, 1.0 / 479001600.0, 1.0 / 39916800.0, 1.0 / 3628800.0, 1.0 / 362880.0, 1.0 / 40320.0,
                                1.0 / 5040.0, 1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0);
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(sum) + (std::bit_cast<std::uint64_t>(shifted) << 52));
}

/// ln x of a positive normal number, absolute error below 1e-15 (1 + |ln x|).
/// The mantissa m in [sqrt(1/2), sqrt(2)) enters as 2 atanh((m - 1) / (m + 1)).
[[gnu::always_inline]] inline double LogOfPositive(double x) {
  constexpr std::uint64_t kSqrtHalf = 0x3FE6A09E667F3BCDu, kBias = std::uint64_t{1024} << 52;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const std::uint64_t exponent = (bits - kSqrtHalf + kBias) >> 52;  // plus 1024: never negative
  const double m = std::bit_cast<double>(bits - (exponent << 52) + kBias);
  const double n = std::bit_cast<double>(exponent | 0x4330000000000000u) - (0x1p52 + 1024.0);
  const double s = (m - 1.0) / (m + 1.0), ss = s * s;
  const double sum = Polynomial(ss, 1.0 / 19.0, 1.0 / 17.0, 1.0 / 15.0, 1.0 / 13.0, 1.0 / 11.0, 1.0 / 9.0, 1.0 / 7.0,
                                1.0 / 5.0, 1.0 / 3.0);
  return n * kLn2High + (n * kLn2Low + 2.0 * (s + s * (ss * sum)));
}

}  // namespace twinbench::diagnose
