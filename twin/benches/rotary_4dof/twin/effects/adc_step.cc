#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

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

}  // namespace

EffectPointer MakeAdcStep(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<AdcStep>(settings);
}

}  // namespace twinbench::sim
