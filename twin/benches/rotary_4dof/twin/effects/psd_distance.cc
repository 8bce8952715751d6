#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// One PSD stands farther from the spot than the scenario says.
class PsdDistance : public Effect {
 public:
  explicit PsdDistance(const EffectSettings& e)
      : psd_(e.where), distance_error_m_(Parameter(e, "distance_error")) {}
  void AlterBench(Scenario& actual) const override { PsdOf(actual, psd_).distance_m += distance_error_m_; }

 private:
  std::string psd_;
  double distance_error_m_;
};

}  // namespace

EffectPointer MakePsdDistance(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<PsdDistance>(settings);
}

}  // namespace twinbench::sim
