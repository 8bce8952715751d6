#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// Uniform light on one PSD pulls the centroid towards its centre.
class StrayLight : public Effect {
 public:
  explicit StrayLight(const EffectSettings& e) : psd_(e.where), fraction_(Parameter(e, "fraction")) {}
  void AlterBench(Scenario& actual) const override { PsdOf(actual, psd_).stray_fraction += fraction_; }

 private:
  std::string psd_;
  double fraction_;
};

}  // namespace

EffectPointer MakeStrayLight(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<StrayLight>(settings);
}

}  // namespace twinbench::sim
