#include "twin/benches/encoder_comparison/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// The device counts too much for every turn, from where its reference starts to count.
class Scale : public AngleEffect {
 public:
  explicit Scale(const EffectSettings& e) : ratio_(Parameter(e, "ratio")) {}
  double ShaftError_rad(const AngleMoment& moment) const override { return ratio_ * moment.shaft_rad; }

 private:
  double ratio_;
};

}  // namespace

AngleEffectPointer MakeScale(const EffectSettings& settings) {
  return std::make_unique<Scale>(settings);
}

}  // namespace twinbench::sim
