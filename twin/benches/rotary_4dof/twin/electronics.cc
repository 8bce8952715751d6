#include "twin/benches/rotary_4dof/twin/electronics.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/psd_noise.h"
#include "twin/core/errors.h"
#include "twin/sim/code_width_table.h"

namespace twinbench::sim {
namespace {

std::array<std::size_t, kChannels> ScanOf(const std::vector<std::string>& scan_list) {
  std::array<std::size_t, kChannels> scan{};
  Require(scan_list.size() == kChannels, "the scan list names every channel once");
  for (std::size_t place = 0; place < kChannels; ++place) {
    const auto found = std::find(kChannelNames.begin(), kChannelNames.end(), scan_list[place]);
    Require(found != kChannelNames.end(), "the scan list names a channel that does not exist");
    scan[place] = static_cast<std::size_t>(found - kChannelNames.begin());
  }
  return scan;
}

/// Of samples that scatter about a level.
double ShareAbove(double threshold_V, double level_V, double noise_V) {
  return 0.5 * std::erfc((threshold_V - level_V) / (std::sqrt(2.0) * noise_V));
}

CodeWidths WidthsOf(const RotarySettings& bench, std::uint64_t seed) {
  const std::string& file = bench.chain.dnl_file;
  return file.empty() ? CodeWidths(bench.chain.dnl_lsb, bench.adc.bits, seed)
                      : CodeWidths(ReadExcessWidths_lsb(file, bench.adc.bits), bench.adc.bits);
}

}  // namespace

Electronics::Electronics(const Scenario& actual, const SamplingState& sampling)
    : psd_{RotaryOf(actual).psd_a, RotaryOf(actual).psd_b},
      rin_dB_Hz_(RotaryOf(actual).laser.rin_dB_Hz),
      adc_(RotaryOf(actual).adc),
      amplifier_(RotaryOf(actual).amplifier),
      sensitivity_V_m_{RotaryOf(actual).psd_a.sensitivity_V_m, RotaryOf(actual).psd_a.sensitivity_V_m,
                       RotaryOf(actual).psd_b.sensitivity_V_m, RotaryOf(actual).psd_b.sensitivity_V_m},
      sampling_(sampling),
      scan_(ScanOf(RotaryOf(actual).adc.scan_list)),
      noise_free_(actual.noise_free),
      seed_(actual.RunSeed()),
      noise_(actual.RunSeed(), "amplifier.noise"),
      low_pass_(RotaryOf(actual).chain.low_pass_Hz),
      widths_(WidthsOf(RotaryOf(actual), actual.seed)) {
  if (!low_pass_.PassesAll()) {
    for (PsdSettings& psd : psd_) psd.bandwidth_Hz = std::min(psd.bandwidth_Hz, low_pass_.NoiseBand_Hz());
  }
  if (!adc_.inl_file.empty())
    non_linearity_V_ = ReadSampledCurve(adc_.inl_file, {"voltage_V"}, {"error_mV", units::mV});
  for (const char* channel : kChannelNames)
    flicker_.emplace_back(amplifier_.flicker_V, actual.RunSeed(), std::string("amplifier.flicker.") + channel);
}

double Electronics::Shortest_s() const {
  return flicker_.front().Shortest_s();
}

void Electronics::AddFlicker(Time now, std::array<double, kChannels>& signal_V) const {
  for (std::size_t c = 0; c < kChannels; ++c) signal_V[c] += flicker_[c].At(ToSeconds(now));
}

/// With the converter's integral non-linearity, which is smooth over the noise of a sample.
double Electronics::AsConverted_V(double voltage_V) const {
  return non_linearity_V_.IsEmpty() ? voltage_V : voltage_V + non_linearity_V_.At(voltage_V);
}

/// What a wrong instant makes of a signal that changes, to first order: slope times jitter.
double Electronics::JitterNoise_V(const BlockCourse& course, std::size_t channel) const {
  const double hum_V_s = amplifier_.hum_V * units::turn * amplifier_.hum_Hz / std::sqrt(2.0);
  return noise_free_ ? 0.0 : adc_.jitter_s * std::hypot(course.RmsSlope_V_s(channel), hum_V_s);
}

/// Scans of a block that reach the computer; one at least.
int Electronics::Arriving(int n_samples, int reading) const {
  if (adc_.lost_fraction == 0.0) return n_samples;
  Stream lost(seed_, "adc.lost");
  lost.Seek(static_cast<std::uint64_t>(reading) << 32);
  int arriving = 0;
  for (int k = 0; k < n_samples; ++k) arriving += lost.Uniform() < adc_.lost_fraction ? 0 : 1;
  return std::max(1, arriving);
}

std::array<double, kChannels> Electronics::Amplify(const std::array<double, kChannels>& spots_m) const {
  std::array<double, kChannels> signal_V{};
  for (int c = 0; c < kChannels; ++c) {
    signal_V[c] = sensitivity_V_m_[c] * (1.0 + amplifier_.gain_error[c]) * spots_m[c] + amplifier_.offset_V[c];
  }
  return signal_V;
}

LightNoise Electronics::LightNoiseOf(const Spots& spots) const {
  LightNoise noise;
  for (std::size_t c = 0; c < kChannels; ++c) {
    const PsdSettings& psd = psd_[c / 2];
    const double length_m = c % 2 == 0 ? psd.width_m : psd.height_m;
    const double noise_m = PsdNoise_m(psd, spots.power_W[c / 2], length_m, spots.uv_m[c]);
    const double gain_V_m = sensitivity_V_m_[c] * (1.0 + amplifier_.gain_error[c]);
    noise.own_V[c] = std::abs(gain_V_m) * noise_m;
    noise.common_V[c] = gain_V_m * IntensityNoise_m(psd, rin_dB_Hz_, spots.power_W[c / 2], spots.uv_m[c]);
  }
  return noise;
}

void Electronics::AddPoledNoise(const LightNoise& light_noise, double step_s, int reading,
                                BlockCourse& course) const {
  Stream stream(seed_, "light.low_passed");
  stream.Seek(static_cast<std::uint64_t>(reading) << 32);
  PoledNoise laser(1.0, step_s, Lag_s());
  std::vector<PoledNoise> own;
  for (const double own_V : light_noise.own_V) own.emplace_back(own_V, step_s, Lag_s());
  double power = 0.0;  // in standard deviations of it
  course.Stir([&](std::size_t c) {
    if (c == 0) power = laser.Next(stream);
    return own[c].Next(stream) + light_noise.common_V[c] * power;
  });
}

/// Knots at every conversion.
BlockCourse Electronics::LowPassed(const BlockCourse& course, const std::optional<BlockCourse>& before,
                                   const LightNoise& light_noise, int reading, int n_samples) const {
  const int steps = static_cast<int>(kChannels) * n_samples;
  const Duration step = BlockTime(adc_, n_samples) / steps;
  BlockCourse passed = low_pass_.Passed(course, step, steps, before);
  if (!noise_free_) AddPoledNoise(light_noise, ToSeconds(step), reading, passed);
  return passed;
}

/// Of signals that stand still in the block.
AdInput Electronics::InScanOrder(const std::array<double, kChannels>& level_V, Time start) const {
  AdInput input;
  for (std::size_t place = 0; place < kChannels; ++place) {
    const std::size_t c = scan_[place];
    ChannelInput& channel = input.channel[place];
    channel.level_V = level_V[c];
    channel.noise_V = amplifier_.noise_V;
    channel.crosstalk = sampling_.crosstalk[c];
    channel.step_V = sampling_.step_V[c];
    channel.step_threshold_V = sampling_.step_at_V[c];
  }
  // Whole turns are taken off before the sine sees them, so that the phase keeps its digits after hours.
  const double turns = amplifier_.hum_Hz * ToSeconds(start);
  if (!widths_.AreEqual()) input.widths = &widths_;
  input.hum = {amplifier_.hum_V, amplifier_.hum_Hz, 2.0 * units::kPi * (turns - std::floor(turns))};
  return input;
}

/// What the signals do in the block. `course` outlives the input.
void Electronics::Follow(const BlockCourse& course, AdInput& input) const {
  constexpr double kSteady = 1e-3;  // of a code step
  const double within_V = kSteady * LsbOf(adc_);
  if (course.IsLevel(within_V)) return;
  const bool is_straight = course.IsStraight(within_V);
  for (std::size_t place = 0; place < kChannels; ++place) {
    const std::size_t c = scan_[place];
    ChannelInput& channel = input.channel[place];
    if (is_straight) {
      channel.level_V = course.At_V(c, 0.0);
      channel.slope_V_s = course.Slope_V_s(c);
    } else {
      channel.extra_V = [&course, c, level_V = channel.level_V](double t_s) {
        return course.At_V(c, t_s) - level_V;
      };
    }
  }
}

Acquisition Electronics::InChannelOrder(const Acquisition& scanned) const {
  Acquisition block = scanned;
  block.saturated_mask = 0;
  for (std::size_t place = 0; place < kChannels; ++place) {
    block.channel[scan_[place]] = scanned.channel[place];
    if ((scanned.saturated_mask >> place & 1) != 0) block.saturated_mask |= 1 << scan_[place];
    for (std::size_t scan = 0; scan + kChannels <= block.raw.size(); scan += kChannels) {
      block.raw[scan + scan_[place]] = scanned.raw[scan + place];
    }
  }
  return block;
}

Acquisition Electronics::Convert(BlockCourse course, const std::optional<BlockCourse>& before,
                                 const LightNoise& light_noise, Time start, int reading, int n_samples,
                                 bool keep_raw) {
  noise_.Seek(static_cast<std::uint64_t>(reading) << 32);
  LightNoise fresh = light_noise;  // with every sample
  if (!low_pass_.PassesAll()) {
    course = LowPassed(course, before, light_noise, reading, n_samples);
    fresh = {};
  }
  course.Bend([this](double voltage_V) { return AsConverted_V(voltage_V); });
  AdInput input = InScanOrder(course.Means_V(), start);
  Follow(course, input);
  for (std::size_t place = 0; place < kChannels; ++place) {
    const std::size_t c = scan_[place];
    double& noise_V = input.channel[place].noise_V;
    noise_V = std::hypot(noise_V, fresh.own_V[c], JitterNoise_V(course, c));
    if (fresh.common_V[c] != 0.0) noise_V = std::hypot(noise_V, fresh.common_V[c]);
  }
  const AdRequest request{Arriving(n_samples, reading), adc_.every_sample, keep_raw, noise_free_};
  return InChannelOrder(TakeBlock(adc_, input, request, noise_).ToAcquisition(start));
}

std::array<double, kChannels> Electronics::Expect(std::array<double, kChannels> signal_V, Time start, int n_samples,
                                                  double noise_V) const {
  for (double& voltage_V : signal_V) voltage_V = AsConverted_V(voltage_V);
  AdInput input = InScanOrder(signal_V, start);
  const bool blurred = noise_V > 0.0;  // else the block itself says where its samples lie
  for (ChannelInput& channel : input.channel) channel.step_V = blurred ? 0.0 : channel.step_V;
  Stream unused(0, "electronics.expectation");
  const AdBlock block = TakeBlock(adc_, input, {n_samples, false, false, true}, unused);
  std::array<double, kChannels> mean_V{};
  for (std::size_t place = 0; place < kChannels; ++place) {
    const std::size_t c = scan_[place];
    const double level_V = block.channel[place].mean_V;
    mean_V[c] = level_V;
    if (!blurred) continue;
    mean_V[c] += sampling_.step_V[c] * ShareAbove(sampling_.step_at_V[c], level_V, noise_V);
    if (!widths_.AreEqual())
      mean_V[c] += LsbOf(adc_) * widths_.Shift_lsb(level_V / LsbOf(adc_), noise_V / LsbOf(adc_));
  }
  return mean_V;
}

}  // namespace twinbench::sim
