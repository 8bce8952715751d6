#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/effects/effects.h"
#include "twin/sim/outlier_draw.h"

namespace twinbench::sim {
namespace {

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

}  // namespace

EffectPointer MakeOutliers(const EffectSettings& settings, const Scenario& scenario) {
  return std::make_unique<Outliers>(settings, scenario);
}

}  // namespace twinbench::sim
