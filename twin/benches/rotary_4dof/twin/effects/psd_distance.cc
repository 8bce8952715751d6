#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// One PSD stands farther from the spot than the scenario says, or both do by as much.
class PsdDistance : public Effect {
 public:
  explicit PsdDistance(const EffectSettings& e)
      : psd_(e.where), distance_error_m_(Parameter(e, "distance_error")) {}
  void AlterBench(Scenario& actual) const override {
    for (const char* psd : {"psd_a", "psd_b"}) {
      if (psd_ == psd || psd_ == "both") PsdOf(actual, psd).distance_m += distance_error_m_;
    }
  }

 private:
  std::string psd_;
  double distance_error_m_;
};

}  // namespace

EffectPointer MakePsdDistance(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<PsdDistance>(settings);
}

}  // namespace twinbench::sim
