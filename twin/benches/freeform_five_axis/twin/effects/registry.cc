#include <functional>
#include <map>

#include "twin/benches/freeform_five_axis/twin/effects/effects.h"
#include "twin/core/errors.h"

namespace twinbench::sim {

FreeformEffectPointer MakeFreeformEffect(const EffectSettings& effect, const Scenario& scenario) {
  const std::map<std::string, std::function<FreeformEffectPointer()>> makers = {
      {"qpd_gain", [&] { return MakeGainOrLeakage(effect); }},
      {"leakage", [&] { return MakeGainOrLeakage(effect); }},
      {"laser_drift", [&] { return MakeSpotDrift(effect); }},
      {"qpd_roll", [&] { return MakeAxesTurned(effect); }},
      {"ccd_nonlinearity", [&] { return MakeCameraFault(effect, scenario); }},
      {"slope_crosstalk", [&] { return MakeCameraFault(effect, scenario); }},
      {"artefact_pitch", [&] { return MakeArtefactPitch(effect, scenario); }},
      {"artefact_form", [&] { return MakeArtefactForm(effect, scenario); }},
      {"cyclic", [&] { return MakeCyclic(effect); }},
      {"backlash", [&] { return MakeAxisBacklash(effect); }},
      {"thermal_growth", [&] { return MakeThermalGrowth(effect); }},
      {"slip", [&] { return MakeArtefactSlip(effect); }},
      {"tone", [&] { return MakeTone(effect); }},
      {"outliers", [&] { return MakeFreeformOutliers(effect, scenario); }},
      {"signal", [&] { return MakeFreeformSignal(effect, scenario); }},
  };
  const auto found = makers.find(effect.name);
  Require(found != makers.end(), "the catalogue has an effect that the twin has not");
  return found->second();
}

}  // namespace twinbench::sim
