#include "twin/benches/turntable_autocollimator/twin/effects/effects.h"
#include "twin/sim/outlier_draw.h"

namespace twinbench::sim {
namespace {

/// A draught in the beam disturbs one axis.
class AutocollimatorOutliers : public TurntableEffect {
 public:
  AutocollimatorOutliers(const EffectSettings& e, const Scenario& scenario) : draw_(e, scenario.RunSeed()) {}
  Eigen::Vector2d ReadingError_rad(const TurntableMoment& moment, const Eigen::Vector2d&) const override {
    const OutlierDraw::Drawn drawn = draw_.At(moment.reading);
    return OnAxis(drawn.uniform < 0.5 ? "x" : "y", drawn.size);
  }

 private:
  OutlierDraw draw_;
};

}  // namespace

TurntableEffectPointer MakeAutocollimatorOutliers(const EffectSettings& effect, const Scenario& scenario) {
  return std::make_unique<AutocollimatorOutliers>(effect, scenario);
}

}  // namespace twinbench::sim
