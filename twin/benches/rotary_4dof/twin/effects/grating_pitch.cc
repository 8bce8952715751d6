#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// The grooves of the grating lie farther apart than the scenario says; the PSDs stay where they are.
class GratingPitch : public Effect {
 public:
  explicit GratingPitch(const EffectSettings& e) : pitch_error_(Parameter(e, "pitch_error")) {}
  void AlterBench(Scenario& actual) const override { RotaryOf(actual).grating.lines_per_m /= 1.0 + pitch_error_; }

 private:
  double pitch_error_;
};

}  // namespace

EffectPointer MakeGratingPitch(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<GratingPitch>(settings);
}

}  // namespace twinbench::sim
