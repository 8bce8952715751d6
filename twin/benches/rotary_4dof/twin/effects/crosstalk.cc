#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

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

}  // namespace

EffectPointer MakeCrosstalk(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<Crosstalk>(settings);
}

}  // namespace twinbench::sim
