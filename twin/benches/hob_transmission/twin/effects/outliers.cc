#include "twin/benches/hob_transmission/twin/effects/effects.h"
#include "twin/sim/outlier_draw.h"

namespace twinbench::sim {
namespace {

/// A count that was caught while it changed.
class CounterOutliers : public HobEffect {
 public:
  CounterOutliers(const EffectSettings& e, const Scenario& scenario) : draw_(e, scenario.RunSeed()) {}
  ShownError Shown(const HobMoment& moment) override { return {.table_rad = draw_.At(moment.reading).size}; }

 private:
  OutlierDraw draw_;
};

}  // namespace

HobEffectPointer MakeCounterOutliers(const EffectSettings& effect, const Scenario& scenario) {
  return std::make_unique<CounterOutliers>(effect, scenario);
}

}  // namespace twinbench::sim
