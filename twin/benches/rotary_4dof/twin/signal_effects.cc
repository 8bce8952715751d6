#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/effect.h"
#include "twin/model/block_mean.h"
#include "twin/model/product.h"
#include "twin/sim/empirical_signal.h"
#include "twin/sim/outlier_draw.h"

/// Causes on the way of the light, in the electronics, and in how it is wired and labelled.
namespace twinbench::sim {
namespace {

int ChannelIndex(const std::string& name) {
  const auto found = std::find(kChannelNames.begin(), kChannelNames.end(), name);
  Require(found != kChannelNames.end(), "an effect names a channel that does not exist");
  return static_cast<int>(found - kChannelNames.begin());
}

/// Of the PSD behind a channel.
double Sensitivity_V_m(const Scenario& scenario, int channel) {
  return (channel < 2 ? RotaryOf(scenario).psd_a : RotaryOf(scenario).psd_b).sensitivity_V_m;
}

/// The beam's direction drifts with time, linearly plus a quadratic share that is zero at both ends of the first
/// hour.
class LaserDrift : public Effect {
 public:
  explicit LaserDrift(const EffectSettings& e)
      : yaw_(e.where == "yaw"), drift_rad_s_(Parameter(e, "drift")), curvature_(Parameter(e, "curvature")) {}
  void AlterLight(const Moment& moment, LightState& light) const override {
    const double t_s = ToSeconds(moment.now), hours = t_s / units::hour;
    const double angle_rad = drift_rad_s_ * t_s * (1.0 + curvature_ * (1.0 - hours));
    (yaw_ ? light.yaw_rad : light.pitch_rad) += angle_rad;
  }

 private:
  bool yaw_;
  double drift_rad_s_;
  double curvature_;
};

/// The laser diode goes over to another longitudinal mode at one reading and stays there.
class ModeHop : public Effect {
 public:
  explicit ModeHop(const EffectSettings& e)
      : step_m_(Parameter(e, "wavelength_step")), at_reading_(static_cast<int>(Parameter(e, "at_reading"))) {}
  void AlterLight(const Moment& moment, LightState& light) const override {
    if (moment.reading >= at_reading_) light.wavelength_m += step_m_;
  }

 private:
  double step_m_;
  int at_reading_;
};

/// A slow vibration or an aliased hum: a sine in time on one channel, or on those that a yaw or a tilt moves.
class Tone : public Effect {
 public:
  Tone(const EffectSettings& e, const Scenario& scenario)
      : frequency_Hz_(Parameter(e, "frequency")), phase_rad_(Parameter(e, "phase")) {
    const double amplitude_m = Parameter(e, "amplitude");
    for (int c = 0; c < kChannels; ++c) {
      if (Reaches(e.where, c)) amplitude_V_[c] = amplitude_m * Sensitivity_V_m(scenario, c);
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

/// A product of a channel and a course: on a PSD it adds to the position of the spot.
class Signal : public Effect {
 public:
  Signal(const EffectSettings& settings, const Scenario& scenario)
      : product_(settings, FormatOf(scenario.bench)) {
    for (int c = 0; c < kChannels; ++c) sensitivity_V_m_[c] = Sensitivity_V_m(scenario, c);
  }

  double Shortest_s() const override { return product_.Shortest_s(); }
  double AddedToShown_V(const Moment& moment, const std::array<double, kChannels>& signal_V,
                        int channel) const override {
    if (channel != product_.Channel()) return 0.0;
    std::array<double, kChannels> shown_m{};
    for (std::size_t c = 0; c < shown_m.size(); ++c) shown_m[c] = signal_V[c] / sensitivity_V_m_[c];
    const model::Instant instant{.time_s = ToSeconds(moment.now),
                                 .averaged_s = moment.averaged_s,
                                 .lag_s = moment.lag_s,
                                 .reading = moment.reading,
                                 .direction = static_cast<double>(moment.target_direction),
                                 .above_K = moment.temperature_K,
                                 .angle_rad = {moment.target_rad, moment.reference_rad}};
    return sensitivity_V_m_[static_cast<std::size_t>(channel)] * product_.At(instant, shown_m);
  }

 private:
  model::Product product_;
  std::array<double, kChannels> sensitivity_V_m_{};
};

/// Now and then a whole block is off on one channel: a passer-by, an electrical pulse, a draught.
class Outliers : public Effect {
 public:
  Outliers(const EffectSettings& e, const Scenario& scenario)
      : draw_(e, scenario.RunSeed()), sensitivity_V_m_(RotaryOf(scenario).psd_a.sensitivity_V_m) {}
  void AlterSignal(const Moment& moment, std::array<double, kChannels>& signal_V) override {
    const OutlierDraw::Drawn drawn = draw_.At(moment.reading);
    const auto channel = static_cast<std::size_t>(drawn.uniform * kChannels);
    signal_V[channel] += drawn.size * sensitivity_V_m_;
  }

 private:
  OutlierDraw draw_;
  double sensitivity_V_m_;
};

/// A tabulated signal without a cause: on a PSD it adds to the position of the spot.
class Empirical : public Effect {
 public:
  Empirical(const EmpiricalSettings& settings, const Scenario& scenario)
      : channel_(ChannelIndex(settings.channel)),
        sensitivity_V_m_(Sensitivity_V_m(scenario, channel_)),
        shown_m_({settings}, settings.channel) {}

  void AlterSignal(const Moment& moment, std::array<double, kChannels>& signal_V) override {
    signal_V[static_cast<std::size_t>(channel_)] +=
        sensitivity_V_m_ * shown_m_.At(moment.reading, ToSeconds(moment.now));
  }

 private:
  int channel_;
  double sensitivity_V_m_;
  EmpiricalSignal shown_m_;
};

/// The A/D of one channel jumps at one code, as with a wrong weight of its most significant bit.
class AdcStep : public Effect {
 public:
  explicit AdcStep(const EffectSettings& e)
      : channel_(ChannelIndex(e.where)), step_V_(Parameter(e, "step")), at_V_(Parameter(e, "at_voltage")) {}
  void AlterSampling(SamplingState& sampling) const override {
    sampling.step_V[channel_] += step_V_;
    sampling.step_at_V[channel_] = at_V_;
  }

 private:
  int channel_;
  double step_V_;
  double at_V_;
};

/// The multiplexer keeps part of the channel it converted before: channel k += fraction * channel k - 1.
class Crosstalk : public Effect {
 public:
  explicit Crosstalk(const EffectSettings& e)
      : channel_(ChannelIndex(e.where)), fraction_(Parameter(e, "fraction")) {}
  void AlterSampling(SamplingState& sampling) const override { sampling.crosstalk[channel_] += fraction_; }

 private:
  int channel_;
  double fraction_;
};

/// Wires and labels that are not what everybody believes: exchanged channels, inverted signs, a scale that counts
/// the other way round or starts one step too late.
class Convention : public Effect {
 public:
  Convention(const EffectSettings& e, const Scenario& scenario)
      : where_(e.where), step_rad_(2.0 * units::kPi / RotaryOf(scenario).procedure.positions) {}
  void AlterLabels(double& target_rad, double& reference_rad) const override {
    if (where_ == "reverse_target") target_rad = -target_rad;
    if (where_ == "reverse_reference") reference_rad = -reference_rad;
    if (where_ == "index_offset") target_rad += step_rad_;
  }
  void AlterReadout(Acquisition& block) const override {
    if (where_ == "swap_xy_a") Exchange(block, 0, 1);
    if (where_ == "swap_xy_b") Exchange(block, 2, 3);
    if (where_ == "swap_psds") {
      Exchange(block, 0, 2);
      Exchange(block, 1, 3);
    }
    if (where_.starts_with("negate_")) Negate(block, ChannelIndex(where_.substr(7)));
  }

 private:
  static void Exchange(Acquisition& block, int a, int b) {
    std::swap(block.channel[a], block.channel[b]);
    for (std::size_t scan = 0; scan + kChannels <= block.raw.size(); scan += kChannels) {
      std::swap(block.raw[scan + a], block.raw[scan + b]);
    }
  }
  static void Negate(Acquisition& block, int c) {
    ChannelBlock& channel = block.channel[c];
    channel = {-channel.mean_V, channel.std_V, -channel.max_V, -channel.min_V};
    // Code -32768 has no negative: it becomes the other end of the range, as an inverting amplifier would give.
    for (std::size_t k = c; k < block.raw.size(); k += kChannels) {
      block.raw[k] = static_cast<std::int16_t>(-std::max<int>(block.raw[k], -32767));
    }
  }

  std::string where_;
  double step_rad_;
};

}  // namespace

EffectMakers<Effect> SignalEffects() {
  return {
      {"laser_drift", Made<Effect, LaserDrift>},
      {"mode_hop", Made<Effect, ModeHop>},
      {"tone", Made<Effect, Tone>},
      {"signal", Made<Effect, Signal>},
      {"outliers", Made<Effect, Outliers>},
      {"adc_step", Made<Effect, AdcStep>},
      {"crosstalk", Made<Effect, Crosstalk>},
      {"convention", Made<Effect, Convention>},
  };
}

std::unique_ptr<Effect> MakeEmpirical(const EmpiricalSettings& settings, const Scenario& scenario) {
  return std::make_unique<Empirical>(settings, scenario);
}

}  // namespace twinbench::sim
