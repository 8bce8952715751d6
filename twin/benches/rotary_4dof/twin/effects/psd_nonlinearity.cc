#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// Electrode non-linearity: u -> u (1 + cubic r^2), r the distance of the spot from the PSD's centre.
class PsdNonlinearity : public Effect {
 public:
  explicit PsdNonlinearity(const EffectSettings& e) : psd_(e.where), cubic_per_m2_(Parameter(e, "cubic")) {}
  void AlterBench(Scenario& actual) const override { PsdOf(actual, psd_).cubic_per_m2 += cubic_per_m2_; }

 private:
  std::string psd_;
  double cubic_per_m2_;
};

}  // namespace

EffectPointer MakePsdNonlinearity(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<PsdNonlinearity>(settings);
}

}  // namespace twinbench::sim
