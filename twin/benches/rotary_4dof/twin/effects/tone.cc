#include <cmath>

#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/effects/effects.h"
#include "twin/model/block_mean.h"

namespace twinbench::sim {
namespace {

/// A slow vibration or an aliased hum: a sine in time on one channel, or on those that a yaw or a tilt moves.
class Tone : public Effect {
 public:
  Tone(const EffectSettings& e, const Scenario& scenario)
      : frequency_Hz_(Parameter(e, "frequency")), phase_rad_(Parameter(e, "phase")) {
    const double amplitude_m = Parameter(e, "amplitude");
    for (int c = 0; c < kChannels; ++c) {
      const double sensitivity_V_m = (c < 2 ? RotaryOf(scenario).psd_a : RotaryOf(scenario).psd_b).sensitivity_V_m;
      if (Reaches(e.where, c)) amplitude_V_[c] = amplitude_m * sensitivity_V_m;
    }
  }
  double Shortest_s() const override { return 1.0 / frequency_Hz_; }
  void AlterSignal(const Moment& moment, std::array<double, kChannels>& signal_V) override {
    const model::BehindPole behind = model::SineBehindPole(frequency_Hz_, moment.lag_s);
    const double turned_rad = units::turn * frequency_Hz_ * ToSeconds(moment.now) + behind.ahead_rad;
    const double share = behind.share * model::ShareLeft(frequency_Hz_, moment.averaged_s);
    const double mean = share * std::sin(turned_rad + phase_rad_);
    for (int c = 0; c < kChannels; ++c) signal_V[c] += amplitude_V_[c] * mean;
  }

 private:
  static bool Reaches(const std::string& where, int channel) {
    const bool is_x = channel % 2 == 0;
    return where == "all" || (where == "yaw" && is_x) || (where == "tilt" && !is_x) ||
           where == kChannelNames[channel];
  }

  double frequency_Hz_;
  double phase_rad_;
  std::array<double, kChannels> amplitude_V_{};
};

}  // namespace

EffectPointer MakeTone(const EffectSettings& settings, const Scenario& scenario) {
  return std::make_unique<Tone>(settings, scenario);
}

}  // namespace twinbench::sim
