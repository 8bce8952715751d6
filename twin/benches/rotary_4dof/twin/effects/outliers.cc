#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/effects/effects.h"
#include "twin/core/stream.h"

namespace twinbench::sim {
namespace {

/// Now and then a whole block is off on one channel: a passer-by, an electrical pulse, a draught.
class Outliers : public Effect {
 public:
  Outliers(const EffectSettings& e, const Scenario& scenario)
      : fraction_(Parameter(e, "fraction")),
        size_m_(Parameter(e, "size")),
        sensitivity_V_m_(RotaryOf(scenario).psd_a.sensitivity_V_m),
        stream_(scenario.seed, "effect.outliers") {}
  void AlterSignal(const Moment&, std::array<double, kChannels>& signal_V) override {
    const bool hit = stream_.Uniform() < fraction_;
    const int channel = static_cast<int>(stream_.Uniform() * kChannels);
    const double size_m = (stream_.Uniform() < 0.5 ? -1.0 : 1.0) * size_m_ * (0.5 + stream_.Uniform());
    if (hit) signal_V[channel] += size_m * sensitivity_V_m_;
  }

 private:
  double fraction_;
  double size_m_;
  double sensitivity_V_m_;
  Stream stream_;
};

}  // namespace

EffectPointer MakeOutliers(const EffectSettings& settings, const Scenario& scenario) {
  return std::make_unique<Outliers>(settings, scenario);
}

}  // namespace twinbench::sim
