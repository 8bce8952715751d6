#include "tests/hidden/effect_size.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace twinbench::hidden {
namespace {

/// Of effects whose size goes by one name at every place.
const std::map<std::string, std::string>& UsualSizes() {
  static const std::map<std::string, std::string> sizes = {{"psd_gain", "gain_error"},
                                                           {"psd_roll", "roll"},
                                                           {"psd_nonlinearity", "cubic"},
                                                           {"stray_light", "fraction"},
                                                           {"psd_distance", "distance_error"},
                                                           {"wavelength_offset", "wavelength_error"},
                                                           {"grating_pitch", "pitch_error"},
                                                           {"mode_hop", "wavelength_step"},
                                                           {"incidence_offset", "incidence"},
                                                           {"wavelength_temperature", "wavelength_per_kelvin"},
                                                           {"laser_drift", "drift"},
                                                           {"mount_creep", "amplitude"},
                                                           {"thermal_tilt", "tilt_per_kelvin"},
                                                           {"settling", "amplitude"},
                                                           {"tone", "amplitude"},
                                                           {"bearing_half_frequency", "tilt"},
                                                           {"adc_step", "step"},
                                                           {"crosstalk", "fraction"},
                                                           {"autocollimator_roll", "angle"},
                                                           {"autocollimator_scale", "gain_error"},
                                                           {"autocollimator_nonlinearity", "at_edge"},
                                                           {"autocollimator_periodic", "amplitude"},
                                                           {"autocollimator_drift", "rate"},
                                                           {"autocollimator_temperature", "coefficient"},
                                                           {"mirror_flatness", "sag"},
                                                           {"hob_runout", "amplitude"},
                                                           {"worm", "amplitude"},
                                                           {"eccentricity", "amplitude"},
                                                           {"ellipticity", "amplitude"},
                                                           {"signal_offset", "offset_sin"},
                                                           {"amplitude_mismatch", "ratio"},
                                                           {"quadrature_error", "angle"},
                                                           {"signal_clipping", "level"},
                                                           {"interpolation", "amplitude"},
                                                           {"latency", "delay"},
                                                           {"hysteresis", "lag"},
                                                           {"scale", "ratio"},
                                                           {"drift", "rate"},
                                                           {"periodic", "amplitude"},
                                                           {"gear_mesh", "amplitude"},
                                                           {"reference_fault", "amplitude"}};
  return sizes;
}

void Scale(EffectSettings& effect, const std::string& name, double factor, const std::string& bench) {
  const EffectParameter& p = CatalogueParameter(bench, effect.name, name);
  double& value = effect.parameters.at(name);
  // Clipping grows with what is cut off.
  value = name == "level" ? 1.0 - factor * (1.0 - value) : factor * value;
  value = std::clamp(value, p.lower_SI, p.upper_SI);
}

/// The same effect, `factor` times as large, within the catalogue's bounds.
EffectSettings Scaled(EffectSettings effect, double factor, const std::string& bench) {
  Scale(effect, SizeParameter(effect.name, effect.where), factor, bench);
  if (effect.name == "signal_offset") Scale(effect, "offset_cos", factor, bench);
  return effect;
}

}  // namespace

std::string SizeParameter(const std::string& effect, const std::string& where) {
  if (effect == "slip" && (where == "yaw" || where == "tilt")) return "angle";
  if (effect == "slip") return where == "lateral" ? "shift" : "step";
  if (effect == "backlash") return where.empty() ? "width" : "half_width";
  const auto found = UsualSizes().find(effect);
  return found == UsualSizes().end() ? "" : found->second;
}

bool HasSize(const std::string& effect) {
  return !SizeParameter(effect, "").empty();
}

const EffectParameter& CatalogueParameter(const std::string& bench, const std::string& effect,
                                          const std::string& name) {
  return *std::ranges::find(FindEffect(effect, bench)->parameters, name, &EffectParameter::name);
}

std::vector<Reading> NoiseFree(Scenario scenario, const std::vector<EffectSettings>& effects) {
  scenario.noise_free = true;
  scenario.effects = effects;
  return TakeReadings(scenario);
}

EffectSettings SizedTo(double rho, EffectSettings effect, const Scenario& drawn, const SignatureScale& scale) {
  constexpr int kMostSteps = 4;  // one is enough where the signature is proportional to the size
  const std::vector<Reading> without = NoiseFree(drawn, {});
  for (int step = 0; step < kMostSteps; ++step) {
    const double factor = rho / scale.Rho(NoiseFree(drawn, {effect}), without);
    if (!std::isfinite(factor) || std::abs(factor - 1.0) < 0.03) break;
    effect = Scaled(effect, factor, drawn.bench);
  }
  return effect;
}

}  // namespace twinbench::hidden
