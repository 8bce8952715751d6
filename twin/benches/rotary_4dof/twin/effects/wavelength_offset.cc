#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// The laser shines at another wavelength than the scenario says; the PSDs stay where they are.
class WavelengthOffset : public Effect {
 public:
  explicit WavelengthOffset(const EffectSettings& e) : wavelength_error_m_(Parameter(e, "wavelength_error")) {}
  void AlterBench(Scenario& actual) const override { RotaryOf(actual).laser.wavelength_m += wavelength_error_m_; }

 private:
  double wavelength_error_m_;
};

}  // namespace

EffectPointer MakeWavelengthOffset(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<WavelengthOffset>(settings);
}

}  // namespace twinbench::sim
