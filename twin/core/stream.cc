#include "twin/core/stream.h"

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/core/stream_kernel_math.h"

namespace twinbench {
namespace {

/// FNV-1a, 64 bits.
std::uint64_t HashOf(std::string_view text) {
  std::uint64_t hash = 0xCBF29CE484222325u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3u;
  return hash;
}

/// A bijection of 64 bits in which every input bit reaches every output bit (the finaliser of SplitMix64).
std::uint64_t Mix(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
  return x ^ (x >> 31);
}

PhiloxBlock CounterOf(std::uint64_t block) {
  return {static_cast<std::uint32_t>(block), static_cast<std::uint32_t>(block >> 32), 0u, 0u};
}

}  // namespace

Stream::Stream(std::uint64_t seed, std::string_view name) {
  const std::uint64_t hash = Mix(Mix(seed + 0x9E3779B97F4A7C15u) ^ HashOf(name));
  key_ = {static_cast<std::uint32_t>(hash), static_cast<std::uint32_t>(hash >> 32)};
}

void Stream::Seek(std::uint64_t block) {
  block_ = block;
  used_ = 4;
  has_spare_ = false;
}

std::uint32_t Stream::Word() {
  if (used_ == 4) {
    words_ = Philox(CounterOf(block_++), key_);
    used_ = 0;
  }
  return words_[used_++];
}

double Stream::Uniform() {
  const std::uint64_t high = Word() >> 5, low = Word() >> 6;
  return static_cast<double>((high << 26) | low) * 0x1p-53;
}

double Stream::Normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const double radius = std::sqrt(-2.0 * portable::Log(1.0 - Uniform()));
  const portable::Rotation angle = portable::Turn(Uniform());
  spare_ = radius * angle.sine;
  has_spare_ = true;
  return radius * angle.cosine;
}

/// G. Marsaglia and W. W. Tsang, A simple method for generating gamma variables, ACM TOMS 26 (2000) 363-372:
/// shape >= 1, unit scale.
double Stream::Gamma(double shape) {
  const double d = shape - 1.0 / 3.0;
  const double c = 1.0 / std::sqrt(9.0 * d);
  while (true) {
    const double x = Normal();
    const double base = 1.0 + c * x;
    const double u = 1.0 - Uniform();
    if (base <= 0.0) continue;
    const double v = base * base * base;
    if (u < 1.0 - 0.0331 * (x * x) * (x * x)) return d * v;  // their squeeze: spares both logarithms nearly always
    if (portable::Log(u) < 0.5 * x * x + d - d * v + d * portable::Log(v)) return d * v;
  }
}

double Stream::ChiSquared(double degrees) {
  Require(degrees > 0.0 && std::isfinite(degrees), "chi-squared needs a positive number of degrees of freedom");
  if (degrees >= 2.0) return 2.0 * Gamma(0.5 * degrees);
  // A gamma variable of shape a < 1 is one of shape a + 1 times U^(1 / a); -700 stands for "far below any use".
  const double log_power = portable::Log(1.0 - Uniform()) / (0.5 * degrees);
  return 2.0 * Gamma(0.5 * degrees + 1.0) * portable::Exp(std::max(log_power, -700.0));
}

void Stream::FillNormals(std::span<float> out) {
  const std::size_t whole = out.size() / 4 * 4;
  FillNormalBlocks(simd_, key_, block_, out.first(whole));
  Seek(block_ + whole / 4);
  if (whole == out.size()) return;
  std::array<float, 4> last{};
  FillNormalBlocks(simd_, key_, block_, last);
  std::copy_n(last.begin(), out.size() - whole, out.begin() + static_cast<std::ptrdiff_t>(whole));
  Seek(block_ + 1);
}

}  // namespace twinbench
