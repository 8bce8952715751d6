#include "twin/benches/encoder_comparison/twin/effects/effects.h"
#include "twin/sim/outlier_draw.h"

namespace twinbench::sim {
namespace {

class AngleOutliers : public AngleEffect {
 public:
  AngleOutliers(const EffectSettings& e, const Scenario& scenario) : draw_(e, scenario.RunSeed()) {}
  double DeviceError_rad(const AngleMoment& moment, double) const override { return draw_.At(moment.reading).size; }

 private:
  OutlierDraw draw_;
};

}  // namespace

AngleEffectPointer MakeAngleOutliers(const EffectSettings& settings, const Scenario& scenario) {
  return std::make_unique<AngleOutliers>(settings, scenario);
}

}  // namespace twinbench::sim
