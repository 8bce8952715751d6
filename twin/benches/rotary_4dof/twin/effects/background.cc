#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// A current beside that of the laser's light, even over one PSD: the place of the spot is its share of the whole.
class Background : public Effect {
 public:
  explicit Background(const EffectSettings& e) : psd_(e.where), current_A_(Parameter(e, "current")) {}
  void AlterBench(Scenario& actual) const override { PsdOf(actual, psd_).background_A += current_A_; }

 private:
  std::string psd_;
  double current_A_;
};

}  // namespace

EffectPointer MakeBackground(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<Background>(settings);
}

}  // namespace twinbench::sim
