#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// The rotor of one table lags behind its encoder by `half_width`, on the side it came from: so much more play in
/// its drive, which the mechanics carry out.
class Backlash : public Effect {
 public:
  explicit Backlash(const EffectSettings& e)
      : on_reference_(e.where == "reference"), half_width_rad_(Parameter(e, "half_width")) {}
  void AlterBench(Scenario& actual) const override {
    RotarySettings& own = RotaryOf(actual);
    (on_reference_ ? own.reference : own.target).backlash_rad += 2.0 * half_width_rad_;
  }

 private:
  bool on_reference_;
  double half_width_rad_;
};

}  // namespace

EffectPointer MakeBacklash(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<Backlash>(settings);
}

}  // namespace twinbench::sim
