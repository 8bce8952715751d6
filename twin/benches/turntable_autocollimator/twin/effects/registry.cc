#include <functional>
#include <map>

#include "twin/benches/turntable_autocollimator/twin/effects/effects.h"
#include "twin/core/errors.h"

namespace twinbench::sim {

std::unique_ptr<TurntableEffect> MakeTurntableEffect(const EffectSettings& effect, const Scenario& scenario) {
  const auto constant = [&] { return MakeWrongConstant(effect); };
  const auto zero = [&] { return MakeMovingZero(effect); };
  const std::map<std::string, std::function<TurntableEffectPointer()>> makers = {
      {"autocollimator_scale", constant},
      {"multitooth_seating", constant},
      {"autocollimator_periodic", [&] { return MakePixelPeriod(effect); }},
      {"autocollimator_drift", zero},
      {"mount_creep", zero},
      {"slip", zero},
      {"tone", zero},
      {"signal", [&] { return MakeAutocollimatorSignal(effect, scenario); }},
      {"backlash", [&] { return MakeTurntableBacklash(effect); }},
      {"settling", [&] { return MakeTurntableSettling(effect); }},
      {"outliers", [&] { return MakeAutocollimatorOutliers(effect, scenario); }},
  };
  const auto found = makers.find(effect.name);
  Require(found != makers.end(), "the catalogue has an effect that the twin has not");
  return found->second();
}

}  // namespace twinbench::sim
