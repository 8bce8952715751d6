#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// The target's bearing moves with about half the frequency of the rotor: a tilt that depends on the unwrapped
/// angle.
class BearingHalfFrequency : public Effect {
 public:
  explicit BearingHalfFrequency(const EffectSettings& e)
      : order_(Parameter(e, "order")), tilt_rad_(Parameter(e, "tilt")) {}
  void AlterBench(Scenario& actual) const override {
    RotaryOf(actual).target.half_frequency_order = order_;
    RotaryOf(actual).target.half_frequency_tilt_rad += tilt_rad_;
  }

 private:
  double order_;
  double tilt_rad_;
};

}  // namespace

EffectPointer MakeBearingHalfFrequency(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<BearingHalfFrequency>(settings);
}

}  // namespace twinbench::sim
