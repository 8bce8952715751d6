#include "twin/sim/ad_sampler.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "twin/core/block_statistics.h"
#include "twin/core/errors.h"
#include "twin/sim/ad_sampler_direct.h"
#include "twin/sim/ad_sampler_kernel.h"
#include "twin/sim/ad_waveform.h"
#include "twin/sim/code_widths.h"

namespace twinbench::sim {
namespace {

void RequireSettings(const AdcSettings& adc) {
  Require(adc.bits >= 2 && adc.bits <= 16, "the A/D converter has 2 to 16 bits");
  Require(adc.range_V > 0.0 && std::isfinite(adc.range_V), "the A/D range is positive");
  Require(adc.rate_Hz > 0.0 && std::isfinite(adc.rate_Hz), "the A/D rate is positive");
}

void RequireInput(const AdInput& input) {
  for (const ChannelInput& c : input.channel) {
    Require(std::isfinite(c.level_V) && std::isfinite(c.slope_V_s),
            "an A/D channel needs a finite level and slope");
    Require(c.noise_V >= 0.0 && std::isfinite(c.noise_V), "an A/D channel's noise is not negative");
    Require(std::isfinite(c.crosstalk), "an A/D channel's crosstalk is finite");
    Require(std::isfinite(c.step_V) && !std::isnan(c.step_threshold_V), "an A/D channel's step is finite");
  }
  const Hum& hum = input.hum;
  Require(std::isfinite(hum.amplitude_V) && std::isfinite(hum.frequency_Hz) && std::isfinite(hum.phase_rad),
          "the hum has a finite amplitude, frequency and phase");
}

std::int32_t LowestCode(const AdcSettings& adc) {
  return -(1 << (adc.bits - 1));
}
std::int32_t HighestCode(const AdcSettings& adc) {
  return (1 << (adc.bits - 1)) - 1;
}

QuantiserChannel QuantiserChannelOf(const AdcSettings& adc, const AdInput& input, std::size_t k) {
  const ChannelInput &own = input.channel[k], &before = input.channel[ChannelBefore(k)];
  const double lsb = LsbOf(adc), level = (own.level_V + own.crosstalk * before.level_V) / lsb;
  const double base = std::clamp(std::nearbyint(level), double(LowestCode(adc)), double(HighestCode(adc)));
  return {.noise = static_cast<float>(own.noise_V / lsb),
          .noise_before = static_cast<float>(own.crosstalk * before.noise_V / lsb),
          .step_at = static_cast<float>(own.step_threshold_V / lsb - base),
          .step = static_cast<float>(own.step_V / lsb),
          .base = static_cast<std::int32_t>(base)};
}

Quantiser QuantiserOf(const AdcSettings& adc, const AdInput& input) {
  Quantiser quantiser{.channel = {}, .lowest = LowestCode(adc), .highest = HighestCode(adc)};
  for (std::size_t k = 0; k < kChannels; ++k) quantiser.channel[k] = QuantiserChannelOf(adc, input, k);
  return quantiser;
}

/// Scratch of one chunk: voltages, the same in codes from the base, normals (of the scan before too) and codes.
struct Chunk {
  std::array<double, kChunk> y_V;
  std::array<float, kChunk> signal;
  std::array<float, kChunk + kChannels> normals;
  std::array<std::int32_t, kChunk> codes;
};

void FillSignal(const Waveform& waveform, const Quantiser& quantiser, double lsb_V, std::int64_t first,
                std::size_t n, Chunk& chunk) {
  waveform.Fill(first, std::span(chunk.y_V).first(n));
  for (std::size_t i = 0; i < n; ++i) {
    chunk.signal[i] = static_cast<float>(chunk.y_V[i] / lsb_V - quantiser.channel[i % kChannels].base);
  }
}

/// Where every scan is the same, one tells them all.
void RepeatScan(const Waveform& waveform, const Quantiser& quantiser, double lsb_V, std::size_t n, Chunk& chunk) {
  FillSignal(waveform, quantiser, lsb_V, 0, kChannels, chunk);
  float* const signal = chunk.signal.data();
  for (std::size_t done = kChannels; done < n; done *= 2) std::copy_n(signal, std::min(done, n - done), signal + done);
}

/// The last scan of the chunk before becomes the scan in front of this one.
void NextNormals(std::size_t n, Stream& noise, Chunk& chunk) {
  std::copy_n(chunk.normals.begin() + kChunk, kChannels, chunk.normals.begin());
  noise.FillNormals(std::span(chunk.normals).subspan(kChannels, n));
}

void QuantiseChunk(const CodeWidths* widths, Simd simd, const Quantiser& quantiser, std::size_t n, bool keep_codes,
                   Chunk& chunk, CodeSums& sums) {
  const std::span<const float> signal = std::span(chunk.signal).first(n);
  const std::span<const float> normals = std::span(chunk.normals).first(n + kChannels);
  const std::span<std::int32_t> codes = std::span(chunk.codes).first(n);
  if (widths != nullptr) return Quantise(*widths, quantiser, signal, normals, codes, sums);
  Quantise(simd, quantiser, signal, normals, keep_codes ? codes : std::span<std::int32_t>{}, sums);
}

/// Draws, converts and counts every sample.
CodeSums CountEverySample(const AdcSettings& adc, const AdInput& input, const AdRequest& request,
                          const Quantiser& quantiser, Stream& noise, std::vector<std::int16_t>& raw) {
  const Waveform waveform(adc, input);
  const std::int64_t total = std::int64_t{kChannels} * request.n_samples;
  Chunk chunk;
  CodeSums sums;
  noise.FillNormals(std::span(chunk.normals).subspan(kChunk));
  if (waveform.IsConstant()) {
    const auto n = static_cast<std::size_t>(std::min<std::int64_t>(kChunk, total));
    RepeatScan(waveform, quantiser, LsbOf(adc), n, chunk);
  }
  for (std::int64_t first = 0; first < total; first += kChunk) {
    const auto n = static_cast<std::size_t>(std::min<std::int64_t>(kChunk, total - first));
    if (!waveform.IsConstant()) FillSignal(waveform, quantiser, LsbOf(adc), first, n, chunk);
    NextNormals(n, noise, chunk);
    QuantiseChunk(input.widths, noise.simd(), quantiser, n, request.keep_raw, chunk, sums);
    if (!request.keep_raw) continue;
    for (std::size_t i = 0; i < n; ++i) raw.push_back(static_cast<std::int16_t>(chunk.codes[i]));
  }
  return sums;
}

ChannelBlock BlockOf(const CodeSums& sums, std::size_t k, std::int32_t base, int n_samples, double lsb_V) {
  const CodeMoments moments = {.n = n_samples,
                               .base = base,
                               .deviation = sums.deviation[k],
                               .square = sums.square[k],
                               .lowest = sums.lowest[k],
                               .highest = sums.highest[k]};
  return StatisticsOf(moments, lsb_V);
}

void TakeEverySample(const AdcSettings& adc, const AdInput& input, const AdRequest& request, Stream& noise,
                     AdBlock& block) {
  const Quantiser quantiser = QuantiserOf(adc, input);
  if (request.keep_raw) block.raw.reserve(std::size_t{kChannels} * static_cast<std::size_t>(request.n_samples));
  const CodeSums sums = CountEverySample(adc, input, request, quantiser, noise, block.raw);
  for (std::size_t k = 0; k < kChannels; ++k) {
    block.channel[k] = BlockOf(sums, k, quantiser.channel[k].base, request.n_samples, LsbOf(adc));
    block.saturated[k] = sums.lowest[k] == quantiser.lowest || sums.highest[k] == quantiser.highest;
  }
}

double WithStep(const ChannelInput& channel, double y_V) {
  return channel.step_V != 0.0 && y_V >= channel.step_threshold_V ? y_V + channel.step_V : y_V;
}

/// Running sums of voltages about the first one.
struct VoltageSums {
  double origin_V = kNaN, sum_V = 0.0, squares_V2 = 0.0;
  double min_V = std::numeric_limits<double>::infinity(), max_V = -min_V;

  void Add(double y_V) {
    if (std::isnan(origin_V)) origin_V = y_V;
    sum_V += y_V - origin_V;
    squares_V2 += (y_V - origin_V) * (y_V - origin_V);
    min_V = std::min(min_V, y_V);
    max_V = std::max(max_V, y_V);
  }
  ChannelBlock Block(double n) const {
    const double squares = std::max(squares_V2 - sum_V * (sum_V / n), 0.0);
    return {origin_V + sum_V / n, n < 2.0 ? kNaN : std::sqrt(squares / (n - 1.0)), min_V, max_V};
  }
};

bool IsEndVoltage(const AdcSettings& adc, const ChannelBlock& block) {
  const double lsb = LsbOf(adc);
  return block.min_V <= (LowestCode(adc) + 0.5) * lsb || block.max_V >= (HighestCode(adc) - 0.5) * lsb;
}

void TakeNoiseFree(const AdcSettings& adc, const AdInput& input, const AdRequest& request, AdBlock& block) {
  const Waveform waveform(adc, input);
  // Where every scan is the same, one tells the mean, and the sums about it are zero.
  const std::int64_t total = std::int64_t{kChannels} * (waveform.IsConstant() ? 1 : request.n_samples);
  std::array<VoltageSums, kChannels> sums;
  std::array<double, kChunk> y_V;
  for (std::int64_t first = 0; first < total; first += kChunk) {
    const auto n = static_cast<std::size_t>(std::min<std::int64_t>(kChunk, total - first));
    waveform.Fill(first, std::span(y_V).first(n));
    for (std::size_t i = 0; i < n; ++i) sums[i % kChannels].Add(WithStep(input.channel[i % kChannels], y_V[i]));
  }
  for (std::size_t k = 0; k < kChannels; ++k) {
    block.channel[k] = sums[k].Block(request.n_samples);
    block.saturated[k] = IsEndVoltage(adc, block.channel[k]);
  }
}

/// Clipped samples are not averaged.
void JudgeSaturation(AdBlock& block) {
  for (std::size_t k = 0; k < kChannels; ++k) {
    if (!block.saturated[k]) continue;
    block.status = ReadingStatus::kSaturated;
    block.channel[k].mean_V = block.channel[k].std_V = kNaN;
  }
}

/// Scans that are converted before the FIFO is full; the computer empties it all the while.
double ScansUntilOverrun(const AdcSettings& adc) {
  if (adc.fifo_samples <= 0 || adc.drain_rate_Hz >= adc.rate_Hz) return std::numeric_limits<double>::infinity();
  return std::floor(adc.fifo_samples / (1.0 - adc.drain_rate_Hz / adc.rate_Hz) / kChannels);
}

}  // namespace

double LsbOf(const AdcSettings& adc) {
  return adc.range_V / static_cast<double>(1 << (adc.bits - 1));
}

Acquisition AdBlock::ToAcquisition(Time start) const {
  Acquisition block;
  block.start = start;
  block.status = status;
  block.n_samples = n_samples;
  block.channel = channel;
  block.raw = raw;
  for (std::size_t k = 0; k < kChannels; ++k) block.saturated_mask |= saturated[k] ? 1 << k : 0;
  return block;
}

AdBlock TakeBlock(const AdcSettings& adc, const AdInput& input, const AdRequest& request, Stream& noise) {
  RequireSettings(adc);
  RequireInput(input);
  Require(request.n_samples > 0, "a block has at least one sample");
  AdBlock block;
  block.n_samples = request.n_samples;
  if (const double scans = ScansUntilOverrun(adc); request.n_samples > scans) {
    block.status = ReadingStatus::kOverrun;
    block.n_samples = static_cast<int>(scans);
    return block;
  }
  if (request.noise_free) {
    TakeNoiseFree(adc, input, request, block);
  } else if (!request.every_sample && !request.keep_raw && CanDrawDirectly(adc, input, request.n_samples)) {
    block.channel = DrawDirectly(adc, input, request.n_samples, noise);
  } else {
    block.drew_every_sample = true;
    TakeEverySample(adc, input, request, noise, block);
  }
  JudgeSaturation(block);
  return block;
}

}  // namespace twinbench::sim
