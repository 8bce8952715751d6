#include <algorithm>
#include <map>

#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/effects/effects.h"
#include "twin/core/errors.h"

namespace twinbench::sim {

std::unique_ptr<Effect> MakeEffect(const EffectSettings& effect, const Scenario& scenario) {
  using Maker = EffectPointer (*)(const EffectSettings&, const Scenario&);
  static const std::map<std::string, Maker> makers = {
      {"psd_gain", MakePsdGain},
      {"psd_roll", MakePsdRoll},
      {"psd_nonlinearity", MakePsdNonlinearity},
      {"stray_light", MakeStrayLight},
      {"background", MakeBackground},
      {"psd_distance", MakePsdDistance},
      {"wavelength_offset", MakeWavelengthOffset},
      {"grating_pitch", MakeGratingPitch},
      {"grating_form", MakeGratingForm},
      {"mode_hop", MakeModeHop},
      {"signal", MakeSignal},
      {"wavelength_temperature", MakeWavelengthTemperature},
      {"incidence_offset", MakeIncidenceOffset},
      {"laser_drift", MakeLaserDrift},
      {"post_growth", MakePostGrowth},
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

PsdSettings& PsdOf(Scenario& scenario, const std::string& name) {
  Require(name == "psd_a" || name == "psd_b", "an effect names a PSD that does not exist");
  return name == "psd_a" ? RotaryOf(scenario).psd_a : RotaryOf(scenario).psd_b;
}

}  // namespace twinbench::sim
