#include <map>

#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// A signal without a cause, tabulated by reading: on a PSD it adds to the position of the spot.
class Empirical : public Effect {
 public:
  Empirical(const EmpiricalSettings& settings, const Scenario& scenario)
      : channel_(ChannelIndex(settings.channel)),
        sensitivity_V_m_((channel_ < 2 ? RotaryOf(scenario).psd_a : RotaryOf(scenario).psd_b).sensitivity_V_m) {
    for (std::size_t i = 0; i < settings.reading.size(); ++i)
      value_m_[settings.reading[i]] = settings.value_m.at(i);
  }
  void AlterSignal(const Moment& moment, std::array<double, kChannels>& signal_V) override {
    const auto found = value_m_.find(moment.reading);
    if (found != value_m_.end()) signal_V[static_cast<std::size_t>(channel_)] += sensitivity_V_m_ * found->second;
  }

 private:
  int channel_;
  double sensitivity_V_m_;
  std::map<int, double> value_m_;
};

}  // namespace

EffectPointer MakeEmpirical(const EmpiricalSettings& settings, const Scenario& scenario) {
  return std::make_unique<Empirical>(settings, scenario);
}

}  // namespace twinbench::sim
