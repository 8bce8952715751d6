#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// The grating's front is a sphere or a saddle: where the beam meets it beside its middle it stands aslant.
class GratingForm : public Effect {
 public:
  explicit GratingForm(const EffectSettings& e)
      : is_sphere_(e.where == "sphere"), height_m_(Parameter(e, "height")) {}
  void AlterBench(Scenario& actual) const override {
    GratingSettings& grating = RotaryOf(actual).grating;
    (is_sphere_ ? grating.sphere_m : grating.astigmatism_m) += height_m_;
  }

 private:
  bool is_sphere_;
  double height_m_;
};

}  // namespace

EffectPointer MakeGratingForm(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<GratingForm>(settings);
}

}  // namespace twinbench::sim
