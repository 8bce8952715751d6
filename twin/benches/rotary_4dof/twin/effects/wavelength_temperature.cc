#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// The laser diode's wavelength follows the room temperature.
class WavelengthTemperature : public Effect {
 public:
  explicit WavelengthTemperature(const EffectSettings& e)
      : wavelength_per_kelvin_m_(Parameter(e, "wavelength_per_kelvin")) {}
  void AlterBench(Scenario& actual) const override {
    RotaryOf(actual).laser.wavelength_per_kelvin_m += wavelength_per_kelvin_m_;
  }

 private:
  double wavelength_per_kelvin_m_;
};

}  // namespace

EffectPointer MakeWavelengthTemperature(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<WavelengthTemperature>(settings);
}

}  // namespace twinbench::sim
