#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/effects/effects.h"
#include "twin/sim/empirical_signal.h"

namespace twinbench::sim {
namespace {

/// A tabulated signal without a cause: on a PSD it adds to the position of the spot.
class Empirical : public Effect {
 public:
  Empirical(const EmpiricalSettings& settings, const Scenario& scenario)
      : channel_(ChannelIndex(settings.channel)),
        sensitivity_V_m_((channel_ < 2 ? RotaryOf(scenario).psd_a : RotaryOf(scenario).psd_b).sensitivity_V_m),
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

}  // namespace

EffectPointer MakeEmpirical(const EmpiricalSettings& settings, const Scenario& scenario) {
  return std::make_unique<Empirical>(settings, scenario);
}

}  // namespace twinbench::sim
