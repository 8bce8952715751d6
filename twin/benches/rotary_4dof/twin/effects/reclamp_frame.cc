#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// The scenario says `reseat`, but the grating was re-clamped on the reference rotor: the reference's wobble then
/// turns with the set-up (docs/theory.md 3).
class ReclampFrame : public Effect {
 public:
  explicit ReclampFrame(const EffectSettings&) {}
  void AlterMounting(Mounting& mounting) const override {
    mounting.clamp_rad -= mounting.reseat_rad;
    mounting.reseat_rad = 0.0;
    mounting.body_reseated = false;
  }
};

}  // namespace

EffectPointer MakeReclampFrame(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<ReclampFrame>(settings);
}

}  // namespace twinbench::sim
