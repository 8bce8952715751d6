#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// The laser diode goes over to another longitudinal mode at one reading and stays there.
class ModeHop : public Effect {
 public:
  explicit ModeHop(const EffectSettings& e)
      : step_m_(Parameter(e, "wavelength_step")), at_reading_(static_cast<int>(Parameter(e, "at_reading"))) {}
  void AlterLight(const Moment& moment, LightState& light) const override {
    if (moment.reading >= at_reading_) light.wavelength_m += step_m_;
  }

 private:
  double step_m_;
  int at_reading_;
};

}  // namespace

EffectPointer MakeModeHop(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<ModeHop>(settings);
}

}  // namespace twinbench::sim
