#include "twin/benches/hob_transmission/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// Sine and cosine of the hob's encoder are not what they should be.
class HobSignalFault : public HobEffect {
 public:
  explicit HobSignalFault(const EffectSettings& e) : effect_(e) {}
  void AlterHobSignals(mechanics::SignalState& signals) const override {
    if (effect_.name == "signal_offset") {
      signals.offset_sin += Parameter(effect_, "offset_sin");
      signals.offset_cos += Parameter(effect_, "offset_cos");
    }
    if (effect_.name == "amplitude_mismatch") signals.ratio += Parameter(effect_, "ratio");
    if (effect_.name == "quadrature_error") signals.quadrature_rad += Parameter(effect_, "angle");
  }

 private:
  EffectSettings effect_;
};

}  // namespace

HobEffectPointer MakeHobSignalFault(const EffectSettings& effect) {
  return std::make_unique<HobSignalFault>(effect);
}

}  // namespace twinbench::sim
