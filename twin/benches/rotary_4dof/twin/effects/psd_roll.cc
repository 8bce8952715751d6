#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// One PSD is turned about the beam.
class PsdRoll : public Effect {
 public:
  explicit PsdRoll(const EffectSettings& e) : psd_(e.where), roll_rad_(Parameter(e, "roll")) {}
  void AlterBench(Scenario& actual) const override { PsdOf(actual, psd_).roll_rad += roll_rad_; }

 private:
  std::string psd_;
  double roll_rad_;
};

}  // namespace

EffectPointer MakePsdRoll(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<PsdRoll>(settings);
}

}  // namespace twinbench::sim
