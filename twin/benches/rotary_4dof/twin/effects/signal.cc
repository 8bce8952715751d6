#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/effects/effects.h"
#include "twin/model/product.h"

namespace twinbench::sim {
namespace {

/// A product of a channel and a course: on a PSD it adds to the position of the spot.
class Signal : public Effect {
 public:
  Signal(const EffectSettings& settings, const Scenario& scenario)
      : product_(settings, FormatOf(scenario.bench)),
        sensitivity_V_m_({RotaryOf(scenario).psd_a.sensitivity_V_m, RotaryOf(scenario).psd_a.sensitivity_V_m,
                          RotaryOf(scenario).psd_b.sensitivity_V_m, RotaryOf(scenario).psd_b.sensitivity_V_m}) {}

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
  std::array<double, kChannels> sensitivity_V_m_;
};

}  // namespace

EffectPointer MakeSignal(const EffectSettings& settings, const Scenario& scenario) {
  return std::make_unique<Signal>(settings, scenario);
}

}  // namespace twinbench::sim
