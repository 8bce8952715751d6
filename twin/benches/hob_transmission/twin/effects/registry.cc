#include <functional>
#include <map>

#include "twin/benches/hob_transmission/twin/effects/effects.h"
#include "twin/core/errors.h"

namespace twinbench::sim {

std::unique_ptr<HobEffect> MakeHobEffect(const EffectSettings& effect, const Scenario& scenario) {
  const auto ring = [&] { return MakeRingError(effect); };
  const auto signal = [&] { return MakeHobSignalFault(effect); };
  const auto gear = [&] { return MakeGearError(effect, scenario); };
  const auto shown = [&] { return MakeShownError(effect); };
  const std::map<std::string, std::function<HobEffectPointer()>> makers = {
      {"eccentricity", ring},
      {"ellipticity", ring},
      {"periodic", ring},
      {"signal_offset", signal},
      {"amplitude_mismatch", signal},
      {"quadrature_error", signal},
      {"hob_runout", gear},
      {"worm", gear},
      {"gear_mesh", gear},
      {"hysteresis", [&] { return MakeWindUp(effect); }},
      {"latency", shown},
      {"drift", shown},
      {"slip", shown},
      {"tone", shown},
      {"signal", [&] { return MakeHobSignal(effect, scenario); }},
      {"outliers", [&] { return MakeCounterOutliers(effect, scenario); }},
  };
  const auto found = makers.find(effect.name);
  Require(found != makers.end(), "the catalogue has an effect that the twin has not");
  return found->second();
}

}  // namespace twinbench::sim
