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

void ChangeRoll(const EffectSettings& e, Scenario& actual) {
  TurntableOf(actual).collimator.roll_rad += Parameter(e, "angle");
}

void ChangeScale(const EffectSettings& e, Scenario& actual) {
  const double factor = (1.0 + TurntableOf(actual).autocollimator.gain_error) * (1.0 + Parameter(e, "gain_error"));
  TurntableOf(actual).autocollimator.gain_error = factor - 1.0;
}

void ChangeDistortion(const EffectSettings& e, Scenario& actual) {
  TurntableOf(actual).collimator.error_at_edge_rad += Parameter(e, "at_edge");
}

void ChangeTemperatureCoefficient(const EffectSettings& e, Scenario& actual) {
  CollimatorSettings& c = TurntableOf(actual).collimator;
  (e.where == "x" ? c.x_per_kelvin_rad : c.y_per_kelvin_rad) += Parameter(e, "coefficient");
}

void ChangeFlatness(const EffectSettings& e, Scenario& actual) {
  TurntableOf(actual).mirror.flatness_m += Parameter(e, "sag");
}

void ChangeSeating(const EffectSettings& e, Scenario& actual) {
  double& sd_rad = TurntableOf(actual).multitooth_table.repeatability_sd[static_cast<std::size_t>(Component::kEz)];
  sd_rad = std::hypot(sd_rad, Parameter(e, "scatter"));
}

WrongConstant::Change ChangeOf(const std::string& effect) {
  if (effect == "autocollimator_roll") return ChangeRoll;
  if (effect == "autocollimator_scale") return ChangeScale;
  if (effect == "autocollimator_nonlinearity") return ChangeDistortion;
  if (effect == "autocollimator_temperature") return ChangeTemperatureCoefficient;
  return effect == "mirror_flatness" ? ChangeFlatness : ChangeSeating;
}

}  // namespace

TurntableEffectPointer MakeWrongConstant(const EffectSettings& effect) {
  return std::make_unique<WrongConstant>(effect, ChangeOf(effect.name));
}

}  // namespace twinbench::sim
