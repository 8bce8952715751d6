#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// The amplifier of one channel reads `gain_error` too much.
class PsdGain : public Effect {
 public:
  explicit PsdGain(const EffectSettings& e)
      : channel_(ChannelIndex(e.where)), gain_error_(Parameter(e, "gain_error")) {}
  void AlterBench(Scenario& actual) const override {
    RotaryOf(actual).amplifier.gain_error[channel_] += gain_error_;
  }

 private:
  int channel_;
  double gain_error_;
};

}  // namespace

EffectPointer MakePsdGain(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<PsdGain>(settings);
}

}  // namespace twinbench::sim
