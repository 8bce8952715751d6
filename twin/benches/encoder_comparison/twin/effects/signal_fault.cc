#include <algorithm>

#include "twin/benches/encoder_comparison/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// Sine and cosine that are off centre, unequal, not a quarter period apart or cut off.
class SignalFault : public AngleEffect {
 public:
  explicit SignalFault(const EffectSettings& e) : settings_(e) {}
  void AlterSignals(SignalState& signals) const override {
    if (settings_.name == "signal_offset") {
      signals.offset_sin += Parameter(settings_, "offset_sin");
      signals.offset_cos += Parameter(settings_, "offset_cos");
    }
    if (settings_.name == "amplitude_mismatch") signals.ratio += Parameter(settings_, "ratio");
    if (settings_.name == "quadrature_error") signals.quadrature_rad += Parameter(settings_, "angle");
    if (settings_.name == "signal_clipping")
      signals.clip_level = std::min(signals.clip_level, Parameter(settings_, "level"));
  }

  double SignalZero_rad() const override {
    return settings_.name == "signal_offset" ? 0.0 : Parameter(settings_, "zero");
  }

 private:
  EffectSettings settings_;
};

}  // namespace

AngleEffectPointer MakeSignalFault(const EffectSettings& settings) {
  return std::make_unique<SignalFault>(settings);
}

}  // namespace twinbench::sim
