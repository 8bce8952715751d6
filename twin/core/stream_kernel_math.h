#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

/// Elementary functions whose bits do not depend on the mathematics library: additions, multiplications, divisions
/// and square roots only, all of which IEEE 754 rounds in one way. Needs -ffp-contract=off.
namespace twinbench::portable {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kLn2 = 0.69314718055994530942;

/// 1/21, 1/19, ... 1/3: series of atanh(s) / s behind its 1, highest power first.
inline constexpr std::array<double, 10> kAtanhSeries = [] {
  std::array<double, 10> series{};
  for (int k = 0; k < 10; ++k) series[static_cast<std::size_t>(k)] = 1.0 / (21 - 2 * k);
  return series;
}();

/// (-1)^k / (2k + first)! for k = 8 ... 0: series of the cosine (0) and of sin(x) / x (1).
constexpr std::array<double, 9> CircleSeries(int first) {
  std::array<double, 9> series{};
  double term = 1.0;
  for (int k = 0; k <= 8; ++k) {
    if (k > 0) term /= -(2.0 * k + first) * (2.0 * k + first - 1.0);
    series[static_cast<std::size_t>(8 - k)] = term;
  }
  return series;
}
inline constexpr std::array<double, 9> kCosineSeries = CircleSeries(0);
inline constexpr std::array<double, 9> kSineSeries = CircleSeries(1);

template <std::size_t n>
double Horner(const std::array<double, n>& highest_first, double x) {
  double sum = 0.0;
  for (const double c : highest_first) sum = sum * x + c;
  return sum;
}

/// Natural logarithm of a positive normal number, relative error below 1e-15.
/// The mantissa m in [sqrt(1/2), sqrt(2)) enters as 2 atanh((m - 1) / (m + 1)), summed to where terms vanish.
inline double Log(double x) {
  constexpr std::uint64_t kSqrtHalf = 0x3FE6A09E667F3BCDu;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const auto exponent = static_cast<std::int64_t>(bits - kSqrtHalf) >> 52;
  const double m = std::bit_cast<double>(bits - (static_cast<std::uint64_t>(exponent) << 52));
  const double s = (m - 1.0) / (m + 1.0), ss = s * s;
  return static_cast<double>(exponent) * kLn2 + 2.0 * (s + s * (ss * Horner(kAtanhSeries, ss)));
}

/// Exponential for |x| < 700, relative error below 1e-15 (1 + |x|): power series of the remainder after 2^n.
inline double Exp(double x) {
  const double n = std::floor(x / kLn2 + 0.5);
  const double r = x - n * kLn2;
  double sum = 1.0;
  for (int k = 15; k >= 1; --k) sum = 1.0 + sum * r / k;
  return sum * std::bit_cast<double>(static_cast<std::uint64_t>(static_cast<std::int64_t>(n) + 1023) << 52);
}

struct Rotation {
  double cosine;
  double sine;
};

/// Cosine and sine of an angle up to pi / 4, absolute error below 2e-16 (power series).
inline Rotation SmallRotation(double angle_rad) {
  const double square = angle_rad * angle_rad;
  return {Horner(kCosineSeries, square), angle_rad * Horner(kSineSeries, square)};
}

/// Cosine and sine of `turns` full turns. Absolute error below 1e-15 (1 + |turns|).
inline Rotation Turn(double turns) {
  const double quarters = std::floor(4.0 * turns + 0.5);
  const Rotation small = SmallRotation((4.0 * turns - quarters) * (kPi / 2.0));
  switch (static_cast<std::int64_t>(quarters) & 3) {
    case 0:
      return small;
    case 1:
      return {-small.sine, small.cosine};
    case 2:
      return {-small.cosine, -small.sine};
    default:
      return {small.sine, -small.cosine};
  }
}

/// Cosine and sine of an angle.
inline Rotation Rotate(double angle_rad) {
  return Turn(angle_rad / (2.0 * kPi));
}

}  // namespace twinbench::portable
