#include "twin/benches/encoder_comparison/twin/effects/effects.h"
#include "twin/core/units.h"

namespace twinbench::sim {
namespace {

/// The device counts too much for every turn, from where its reference starts to count, and more so turn by turn.
class Scale : public AngleEffect {
 public:
  explicit Scale(const EffectSettings& e) : ratio_(Parameter(e, "ratio")), curvature_(Parameter(e, "curvature")) {}
  double ShaftError_rad(const AngleMoment& moment) const override {
    return ratio_ * (1.0 + curvature_ * moment.read_rad / units::turn) * moment.read_rad;
  }

 private:
  double ratio_, curvature_;
};

}  // namespace

AngleEffectPointer MakeScale(const EffectSettings& settings) {
  return std::make_unique<Scale>(settings);
}

}  // namespace twinbench::sim
