#include "twin/sim/ad_sampler_direct.h"

#include <algorithm>
#include <cmath>

#include "twin/core/stream_kernel_math.h"
#include "twin/sim/ad_waveform.h"

namespace twinbench::sim {
namespace {

double Squared(double x) {
  return x * x;
}

struct Dirichlet {
  double value, derivative;
};

/// D(x) = sin(n x / 2) / sin(x / 2) and D'(x), for any x: the kernel repeats with 2 pi, up to its sign.
Dirichlet DirichletKernel(double x, int n_samples) {
  const double n = n_samples, turns = std::round(x / (2.0 * portable::kPi));
  const double r = x - turns * (2.0 * portable::kPi);
  const double sign = n_samples % 2 == 0 && std::fmod(turns, 2.0) != 0.0 ? -1.0 : 1.0;
  if (std::abs(n * r) < 1e-3) {  // two terms of the power series; the next one is below 1e-14 of D and 1e-7 of D'
    return {sign * n * (1.0 - r * r * (n * n - 1.0) / 24.0), -sign * n * (n * n - 1.0) * r / 12.0};
  }
  const portable::Rotation whole = portable::Rotate(0.5 * n * r), one = portable::Rotate(0.5 * r);
  const double value = whole.sine / one.sine;
  return {sign * value, sign * 0.5 * (n * whole.cosine - value * one.cosine) / one.sine};
}

/// The hum as one channel sees it, crosstalk included: cosine and sine part about the middle of the block.
struct CentredHum {
  double even_V, odd_V;  // even cos(j x) + odd sin(j x)
};

CentredHum HumOf(const AdcSettings& adc, const AdInput& input, std::size_t channel, int n_samples) {
  const double dt = 1.0 / adc.rate_Hz, middle = 0.5 * (n_samples - 1) * kChannels + static_cast<double>(channel);
  const auto [f, omega] = std::pair(input.channel[channel].crosstalk, 2.0 * portable::kPi * input.hum.frequency_Hz);
  const portable::Rotation own = portable::Rotate(omega * middle * dt + input.hum.phase_rad);
  const portable::Rotation before = portable::Rotate(omega * (middle - 1.0) * dt + input.hum.phase_rad);
  const double a = input.hum.amplitude_V;
  return {a * (own.sine + f * before.sine), a * (own.cosine + f * before.cosine)};
}

/// Level and slope, crosstalk included.
SignalMoments RampMoments(const AdcSettings& adc, const AdInput& input, std::size_t channel, int n_samples) {
  const double n = n_samples, scan = kChannels / adc.rate_Hz, index = static_cast<double>(channel);
  const double t = 0.5 * (n - 1.0) * scan + index / adc.rate_Hz, t_before = t - 1.0 / adc.rate_Hz;
  const ChannelInput &own = input.channel[channel], &before = input.channel[ChannelBefore(channel)];
  const double slope = own.slope_V_s + own.crosstalk * before.slope_V_s;
  return {own.level_V + own.slope_V_s * t + own.crosstalk * (before.level_V + before.slope_V_s * t_before),
          Squared(slope * scan) * n * (n * n - 1.0) / 12.0};
}

void AddHum(const AdcSettings& adc, const AdInput& input, int n_samples,
            std::array<SignalMoments, kChannels>& moments) {
  const double n = n_samples, x = 2.0 * portable::kPi * input.hum.frequency_Hz * kChannels / adc.rate_Hz;
  const Dirichlet once = DirichletKernel(x, n_samples), twice = DirichletKernel(2.0 * x, n_samples);
  for (std::size_t k = 0; k < kChannels; ++k) {
    const CentredHum hum = HumOf(adc, input, k, n_samples);
    const double sum = hum.even_V * once.value;
    const double squares = 0.5 * (Squared(hum.even_V) * (n + twice.value) + Squared(hum.odd_V) * (n - twice.value));
    const ChannelInput& own = input.channel[k];
    const double slope_V =
        (own.slope_V_s + own.crosstalk * input.channel[ChannelBefore(k)].slope_V_s) * kChannels / adc.rate_Hz;
    moments[k].mean_V += sum / n;
    moments[k].squares_V2 += squares - sum * sum / n - 2.0 * slope_V * hum.odd_V * once.derivative;
  }
}

/// Largest distance of the noise-free signal from its level, crosstalk left out.
double ExcursionOf(const AdcSettings& adc, const AdInput& input, std::size_t channel, int n_samples) {
  const double duration = (n_samples + 1.0) * kChannels / adc.rate_Hz;
  return std::abs(input.channel[channel].slope_V_s) * duration + std::abs(input.hum.amplitude_V);
}

/// Variance of one sample: own noise, crosstalk and quantisation.
double SampleVariance(const AdcSettings& adc, const AdInput& input, std::size_t channel) {
  const ChannelInput& own = input.channel[channel];
  return Squared(own.noise_V) + Squared(own.crosstalk * input.channel[ChannelBefore(channel)].noise_V) +
         Squared(LsbOf(adc)) / 12.0;
}

/// What the step adds to every sample if all of [low, high] lies on one side of its threshold; NaN otherwise.
double ConstantStep(const ChannelInput& channel, double low_V, double high_V) {
  if (channel.step_V == 0.0 || high_V < channel.step_threshold_V) return 0.0;
  return low_V >= channel.step_threshold_V ? channel.step_V : kNaN;
}

struct Band {
  double low_V, high_V;
};

/// Where practically every sample lies: the signal and 8 standard deviations (1e-15) either way.
Band BandOf(const AdcSettings& adc, const AdInput& input, std::size_t channel, int n_samples) {
  const ChannelInput &own = input.channel[channel], &before = input.channel[ChannelBefore(channel)];
  const double f = std::abs(own.crosstalk);
  const double level = own.level_V + own.crosstalk * before.level_V;
  const double reach = ExcursionOf(adc, input, channel, n_samples) +
                       f * ExcursionOf(adc, input, ChannelBefore(channel), n_samples) +
                       8.0 * std::sqrt(SampleVariance(adc, input, channel));
  return {level - reach, level + reach};
}

bool ChannelIsSmooth(const AdcSettings& adc, const AdInput& input, std::size_t channel, int n_samples) {
  const ChannelInput& own = input.channel[channel];
  const double noise_lsb = own.noise_V / LsbOf(adc);
  if (own.extra_V || noise_lsb < 0.5 || noise_lsb * std::sqrt(double(n_samples)) < 4.0) return false;
  const Band band = BandOf(adc, input, channel, n_samples);
  const double step = ConstantStep(own, band.low_V, band.high_V);
  const double lowest = -adc.range_V + LsbOf(adc), highest = adc.range_V - 2.0 * LsbOf(adc);
  return band.low_V + step > lowest && band.high_V + step < highest;  // false for a step that is NaN
}

/// Sum of squares of n normals of variance `variance_V2` about their mean, on top of a signal that has `squares_V2`
/// of its own: one of the n - 1 degrees of freedom points along the signal.
double DrawSquares(double squares_V2, double variance_V2, int n_samples, Stream& noise) {
  if (squares_V2 <= 0.0) return variance_V2 * noise.ChiSquared(n_samples - 1.0);
  const double along = Squared(std::sqrt(squares_V2) + std::sqrt(variance_V2) * noise.Normal());
  return n_samples == 2 ? along : along + variance_V2 * noise.ChiSquared(n_samples - 2.0);
}

}  // namespace

std::array<SignalMoments, kChannels> MomentsOf(const AdcSettings& adc, const AdInput& input, int n_samples) {
  std::array<SignalMoments, kChannels> moments;
  for (std::size_t k = 0; k < kChannels; ++k) moments[k] = RampMoments(adc, input, k, n_samples);
  if (input.hum.amplitude_V != 0.0) AddHum(adc, input, n_samples, moments);
  return moments;
}

bool CanDrawDirectly(const AdcSettings& adc, const AdInput& input, int n_samples) {
  if (input.widths != nullptr) return false;
  for (std::size_t k = 0; k < kChannels; ++k) {
    if (!ChannelIsSmooth(adc, input, k, n_samples)) return false;
  }
  return true;
}

std::array<ChannelBlock, kChannels> DrawDirectly(const AdcSettings& adc, const AdInput& input, int n_samples,
                                                 Stream& noise) {
  const std::array<SignalMoments, kChannels> moments = MomentsOf(adc, input, n_samples);
  const double root_n = std::sqrt(static_cast<double>(n_samples)), u_lsb = LsbOf(adc) / std::sqrt(12.0);
  std::array<double, kChannels> mean_noise{};
  for (std::size_t k = 0; k < kChannels; ++k) mean_noise[k] = input.channel[k].noise_V / root_n * noise.Normal();
  std::array<ChannelBlock, kChannels> blocks;
  for (std::size_t k = 0; k < kChannels; ++k) {
    const ChannelInput& own = input.channel[k];
    const double around =
        mean_noise[k] + own.crosstalk * mean_noise[ChannelBefore(k)] + u_lsb / root_n * noise.Normal();
    blocks[k].mean_V = moments[k].mean_V + around;
    if (own.step_V != 0.0) {
      const Band band = BandOf(adc, input, k, n_samples);
      blocks[k].mean_V = moments[k].mean_V + ConstantStep(own, band.low_V, band.high_V) + around;
    }
    if (n_samples < 2) continue;
    const double squares = DrawSquares(moments[k].squares_V2, SampleVariance(adc, input, k), n_samples, noise);
    blocks[k].std_V = std::sqrt(squares / (n_samples - 1.0));
  }
  return blocks;
}

}  // namespace twinbench::sim
