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

/// Mean code of a voltage that scatters normally about a level which has, or nearly has, this code.
/// @param off_lsb  Of the edge below a code from where it should be.
template <class Off>
double MeanCode(double level_lsb, double noise_lsb, std::int32_t code, Off off_lsb) {
  constexpr double kReach = 6.0;  // standard deviations
  const auto above = [&](std::int32_t edge) { return (level_lsb - edge + 0.5 - off_lsb(edge)) / noise_lsb; };
  double mean = code;
  for (std::int32_t edge = code + 1; above(edge) > -kReach; ++edge) mean += ShareBelow(above(edge));
  for (std::int32_t edge = code; above(edge) < kReach; --edge) mean -= ShareBelow(-above(edge));
  return mean;
}

}  // namespace

CodeWidths::CodeWidths(double dnl_lsb, int bits, std::uint64_t seed) : lowest_(-(1 << (bits - 1))) {
  Require(dnl_lsb >= 0.0 && dnl_lsb <= 0.4, "edges of codes do not change places");
  if (dnl_lsb == 0.0) return;
  // A width has the variance of two edges, an edge that of a uniform distribution: (2 reach)^2 / 12.
  const double reach_lsb = std::sqrt(1.5) * dnl_lsb;
  Stream stream(seed, "adc.dnl");
  off_lsb_.resize((std::size_t{1} << bits) + 1);
  for (float& off : off_lsb_) off = static_cast<float>(reach_lsb * (2.0 * stream.Uniform() - 1.0));
}

CodeWidths::CodeWidths(const std::map<std::int32_t, double>& excess_lsb, int bits) : lowest_(-(1 << (bits - 1))) {
  off_lsb_.resize((std::size_t{1} << bits) + 1);
  const auto excess = [&](std::int32_t code) {
    const auto found = excess_lsb.find(code);
    return found == excess_lsb.end() ? 0.0 : found->second;
  };
  const auto put = [&](std::int32_t edge, double off) {
    off_lsb_[static_cast<std::size_t>(edge - lowest_)] = static_cast<float>(off);
  };
  double off_lsb = 0.0;
  for (std::int32_t code = 0; code < -lowest_; ++code) put(code + 1, off_lsb += excess(code));
  off_lsb = 0.0;
  for (std::int32_t code = -1; code >= lowest_; --code) put(code, off_lsb -= excess(code));
}

float CodeWidths::Off_lsb(std::int32_t code) const {
  if (AreEqual()) return 0.0f;
  const std::int64_t k = std::clamp<std::int64_t>(std::int64_t{code} - lowest_, 0, std::ssize(off_lsb_) - 1);
  return off_lsb_[static_cast<std::size_t>(k)];
}

std::int32_t CodeWidths::CodeOf(std::int32_t base, float x_lsb) const {
  const float nearest = std::nearbyint(x_lsb);
  std::int32_t code = base + static_cast<std::int32_t>(nearest);
  float above = x_lsb - nearest;  // of the middle of the code
  for (; above < Off_lsb(code) - 0.5f; --code) above += 1.0f;
  for (; above >= Off_lsb(code + 1) + 0.5f; ++code) above -= 1.0f;
  return code;
}

double CodeWidths::Shift_lsb(double level_lsb, double noise_lsb) const {
  if (AreEqual() || noise_lsb <= 0.0) return 0.0;
  const auto base = static_cast<std::int32_t>(std::lround(level_lsb));
  const std::int32_t code = CodeOf(base, static_cast<float>(level_lsb - base));
  const auto off_lsb = [this](std::int32_t edge) { return double{Off_lsb(edge)}; };
  return MeanCode(level_lsb, noise_lsb, code, off_lsb) -
         MeanCode(level_lsb, noise_lsb, base, [](std::int32_t) { return 0.0; });
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
