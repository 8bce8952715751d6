#include "twin/benches/hob_transmission/settings.h"
#include "twin/benches/hob_transmission/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// A gear that errs once a turn of the hob, of the worm, or with the teeth that the hob would cut.
class GearError : public HobEffect {
 public:
  GearError(const EffectSettings& e, const Scenario& scenario)
      : effect_(e), starts_(HobOf(scenario).transmission.hob_starts) {}
  void AlterGears(mechanics::GearErrors& errors) const override {
    const double amplitude_rad = Parameter(effect_, "amplitude"), phase_rad = Parameter(effect_, "phase");
    if (effect_.name == "worm") errors.worm.push_back({1.0, amplitude_rad, phase_rad});
    if (effect_.name == "hob_runout") errors.hob_drive.push_back({1.0, amplitude_rad, phase_rad});
    if (effect_.name == "gear_mesh")
      errors.hob_drive.push_back({static_cast<double>(starts_), amplitude_rad, phase_rad});
  }

 private:
  EffectSettings effect_;
  int starts_;
};

}  // namespace

HobEffectPointer MakeGearError(const EffectSettings& effect, const Scenario& scenario) {
  return std::make_unique<GearError>(effect, scenario);
}

}  // namespace twinbench::sim
