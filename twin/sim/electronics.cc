#include "twin/sim/electronics.h"

#include <cmath>

namespace twinbench::sim {

Electronics::Electronics(const Scenario& actual, const SamplingState& sampling)
    : adc_(actual.adc),
      amplifier_(actual.amplifier),
      sensitivity_V_m_{actual.psd_a.sensitivity_V_m, actual.psd_a.sensitivity_V_m, actual.psd_b.sensitivity_V_m,
                       actual.psd_b.sensitivity_V_m},
      sampling_(sampling),
      noise_free_(actual.noise_free),
      noise_(actual.seed, "amplifier.noise") {}

std::array<double, kChannels> Electronics::Amplify(const std::array<double, kChannels>& spots_m) const {
  std::array<double, kChannels> signal_V{};
  for (int c = 0; c < kChannels; ++c) {
    signal_V[c] = sensitivity_V_m_[c] * (1.0 + amplifier_.gain_error[c]) * spots_m[c] + amplifier_.offset_V[c];
  }
  return signal_V;
}

Acquisition Electronics::Convert(const std::array<double, kChannels>& signal_V, Time start, int reading,
                                 int n_samples, bool keep_raw) {
  AdInput input;
  for (int c = 0; c < kChannels; ++c) {
    ChannelInput& channel = input.channel[c];
    channel.level_V = signal_V[c];
    channel.noise_V = amplifier_.noise_V;
    channel.crosstalk = sampling_.crosstalk[c];
    channel.step_V = sampling_.step_V[c];
    channel.step_threshold_V = sampling_.step_at_V[c];
  }
  // Whole turns are taken off before the sine sees them, so that the phase keeps its digits after hours.
  const double turns = amplifier_.hum_Hz * ToSeconds(start);
  input.hum = {amplifier_.hum_V, amplifier_.hum_Hz, 2.0 * units::kPi * (turns - std::floor(turns))};
  noise_.Seek(static_cast<std::uint64_t>(reading) << 32);
  return TakeBlock(adc_, input, {n_samples, adc_.every_sample, keep_raw, noise_free_}, noise_).ToAcquisition(start);
}

Duration Electronics::BlockTime(int n_samples) const {
  return FromSeconds(static_cast<double>(n_samples) * kChannels / adc_.rate_Hz);
}

}  // namespace twinbench::sim
