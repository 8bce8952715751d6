#include <algorithm>
#include <map>

#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/effects/effects.h"
#include "twin/core/errors.h"

namespace twinbench::sim {

std::unique_ptr<Effect> MakeEffect(const EffectSettings& effect, const Scenario& scenario) {
  using Maker = EffectPointer (*)(const EffectSettings&, const Scenario&);
  static const std::map<std::string, Maker> makers = {
      {"mode_hop", MakeModeHop},
      {"signal", MakeSignal},
      {"incidence_offset", MakeIncidenceOffset},
      {"laser_drift", MakeLaserDrift},
      {"mount_creep", MakeMountCreep},
      {"thermal_tilt", MakeThermalTilt},
      {"encoder_subdivision", MakeEncoderSubdivision},
      {"backlash", MakeBacklash},
      {"settling", MakeSettling},
      {"reclamp_frame", MakeReclampFrame},
      {"bearing_half_frequency", MakeBearingHalfFrequency},
      {"tone", MakeTone},
      {"slip", MakeSlip},
      {"adc_step", MakeAdcStep},
      {"crosstalk", MakeCrosstalk},
      {"outliers", MakeOutliers},
      {"convention", MakeConvention},
  };
  const auto found = makers.find(effect.name);
  Require(found != makers.end(), "the catalogue has an effect that the twin has not");
  return found->second(effect, scenario);
}

int ChannelIndex(const std::string& name) {
  const auto found = std::find(kChannelNames.begin(), kChannelNames.end(), name);
  Require(found != kChannelNames.end(), "an effect names a channel that does not exist");
  return static_cast<int>(found - kChannelNames.begin());
}

}  // namespace twinbench::sim
