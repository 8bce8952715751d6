#include "twin/sim/code_widths.h"

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/core/stream.h"

namespace twinbench::sim {
namespace {

/// Beyond any code of 16 bits, so that integers hold what is converted.
constexpr float kFarthest_lsb = 262144.0f;

float VoltageOf(const QuantiserChannel& channel, float signal, float normal_before, float normal) {
  const float x = signal + channel.noise * normal + channel.noise_before * normal_before;
  return std::clamp(x >= channel.step_at ? x + channel.step : x, -kFarthest_lsb, kFarthest_lsb);
}

double ShareBelow(double x) {
  return 0.5 * std::erfc(-x / std::sqrt(2.0));
}

}  // namespace

CodeWidths::CodeWidths(double dnl_lsb, int bits, std::uint64_t seed) : lowest_(-(1 << (bits - 1))) {
  Require(dnl_lsb >= 0.0 && dnl_lsb <= 0.4, "edges of codes do not change places");
  if (dnl_lsb == 0.0) return;
  // A width has the variance of two edges, an edge that of a uniform distribution: (2 reach)^2 / 12.
  const double reach_lsb = std::sqrt(1.5) * dnl_lsb;
  Stream stream(seed, "adc.dnl");
  off_lsb_.resize(std::size_t{1} << bits);
  for (float& off : off_lsb_) off = static_cast<float>(reach_lsb * (2.0 * stream.Uniform() - 1.0));
}

float CodeWidths::Off_lsb(std::int32_t code) const {
  const std::int64_t k = std::int64_t{code} - lowest_;
  return k >= 0 && k < std::ssize(off_lsb_) ? off_lsb_[static_cast<std::size_t>(k)] : 0.0f;
}

std::int32_t CodeWidths::CodeOf(std::int32_t base, float x_lsb) const {
  const float nearest = std::nearbyint(x_lsb);
  const std::int32_t code = base + static_cast<std::int32_t>(nearest);
  const float above = x_lsb - nearest;  // of the middle of the code
  if (above < Off_lsb(code) - 0.5f) return code - 1;
  return above >= Off_lsb(code + 1) + 0.5f ? code + 1 : code;
}

double CodeWidths::Shift_lsb(double level_lsb, double noise_lsb) const {
  if (AreEqual() || noise_lsb <= 0.0) return 0.0;
  const double reach_lsb = 6.0 * noise_lsb + 1.0;
  double shift_lsb = 0.0;
  for (double edge = std::floor(level_lsb - reach_lsb); edge <= level_lsb + reach_lsb; edge += 1.0) {
    const double above = level_lsb - (edge - 0.5), off = Off_lsb(static_cast<std::int32_t>(edge));
    shift_lsb += ShareBelow((above - off) / noise_lsb) - ShareBelow(above / noise_lsb);
  }
  return shift_lsb;
}

void Quantise(const CodeWidths& widths, const Quantiser& quantiser, std::span<const float> signal,
              std::span<const float> normals, std::span<std::int32_t> codes, CodeSums& sums) {
  Require(normals.size() == signal.size() + 4 && codes.size() == signal.size(), "a chunk's arrays belong together");
  for (std::size_t i = 0; i < signal.size(); ++i) {
    const QuantiserChannel& channel = quantiser.channel[i % kChannels];
    const float x_lsb = VoltageOf(channel, signal[i], normals[i + 3], normals[i + 4]);
    codes[i] = std::clamp(widths.CodeOf(channel.base, x_lsb), quantiser.lowest, quantiser.highest);
    const std::int64_t deviation = codes[i] - channel.base;
    AddCode(i % kChannels, codes[i], deviation, deviation * deviation, sums);
  }
}

}  // namespace twinbench::sim
