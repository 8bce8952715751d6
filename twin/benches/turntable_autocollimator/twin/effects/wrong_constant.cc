#include <cmath>

#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/benches/turntable_autocollimator/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// A constant of the bench that is not what the scenario says.
class WrongConstant : public TurntableEffect {
 public:
  using Change = void (*)(const EffectSettings&, Scenario&);
  WrongConstant(const EffectSettings& effect, Change change) : effect_(effect), change_(change) {}
  void AlterBench(Scenario& actual) const override { change_(effect_, actual); }

 private:
  EffectSettings effect_;
  Change change_;
};

void ChangeScale(const EffectSettings& e, Scenario& actual) {
  const double factor = (1.0 + TurntableOf(actual).autocollimator.gain_error) * (1.0 + Parameter(e, "gain_error"));
  TurntableOf(actual).autocollimator.gain_error = factor - 1.0;
}

void ChangeSeating(const EffectSettings& e, Scenario& actual) {
  double& sd_rad = TurntableOf(actual).multitooth_table.repeatability_sd[static_cast<std::size_t>(Component::kEz)];
  sd_rad = std::hypot(sd_rad, Parameter(e, "scatter"));
}

}  // namespace

TurntableEffectPointer MakeWrongConstant(const EffectSettings& effect) {
  return std::make_unique<WrongConstant>(effect, effect.name == "autocollimator_scale" ? ChangeScale : ChangeSeating);
}

}  // namespace twinbench::sim
