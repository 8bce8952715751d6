#include <fmt/format.h>

#include "twin/benches/rotary_4dof/bench.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/uncertainty/contribution.h"

namespace twinbench::benches::rotary {
namespace {

using uncertainty::Contribution;

/// As fine as converters of the kind are; the steps of one of 16 bits are part of the floor.
constexpr int kFinestBits = 16;

void SilenceBearings(Scenario& s) {
  RotarySettings& own = RotaryOf(s);
  for (TableSettings* table : {&own.target, &own.reference}) {
    table->repeatability_sd = {};
    table->half_frequency_tilt_rad = table->half_frequency_radial_m = 0.0;
  }
  own.mechanics.asynchronous_radial_m = own.mechanics.asynchronous_axial_m = {};
  own.mechanics.asynchronous_tilt_rad = {};
}

void SilenceAmplifiers(Scenario& s) {
  AmplifierSettings& amplifier = RotaryOf(s).amplifier;
  amplifier.noise_V = amplifier.flicker_V = amplifier.hum_V = 0.0;
}

void SilenceConverter(Scenario& s) {
  AdcSettings& adc = RotaryOf(s).adc;
  adc.bits = kFinestBits;
  adc.jitter_s = 0.0;
  adc.inl_file.clear();
  RotaryOf(s).chain.dnl_lsb = 0.0;
  RotaryOf(s).chain.dnl_file.clear();
}

void SilenceDetectors(Scenario& s) {
  for (PsdSettings* psd : {&RotaryOf(s).psd_a, &RotaryOf(s).psd_b}) psd->bandwidth_Hz = 0.0;
}

void SilenceRoomLight(Scenario& s) {
  for (PsdSettings* psd : {&RotaryOf(s).psd_a, &RotaryOf(s).psd_b}) psd->background_A = 0.0;
}

void FlattenGrating(Scenario& s) {
  GratingSettings& grating = RotaryOf(s).grating;
  grating.sphere_m = grating.astigmatism_m = grating.ruling_chirp_per_m = grating.ruling_fan_rad_m = 0.0;
  grating.flatness_file.clear();
  grating.ruling_file.clear();
}

void SilenceDistances(Scenario& s) {
  for (PsdSettings* psd : {&RotaryOf(s).psd_a, &RotaryOf(s).psd_b}) psd->distance_expansion_per_K = 0.0;
}

void SilencePosts(Scenario& s) {
  RotaryOf(s).laser.post_growth_m_K = 0.0;
  for (PsdSettings* psd : {&RotaryOf(s).psd_a, &RotaryOf(s).psd_b}) psd->post_growth_m_K = 0.0;
}

void SilencePointing(Scenario& s) {
  LaserSettings& laser = RotaryOf(s).laser;
  laser.pointing_yaw_per_kelvin_rad = laser.pointing_pitch_per_kelvin_rad = 0.0;
}

std::vector<Contribution> OfTheBench() {
  return {{"laser wavelength by temperature", [](Scenario& s) { RotaryOf(s).laser.wavelength_per_kelvin_m = 0.0; }},
          {"laser mode hops", [](Scenario& s) { RotaryOf(s).laser.mode_hop_K = 0.0; }},
          {"laser pointing by temperature", SilencePointing},
          {"laser power drift", [](Scenario& s) { RotaryOf(s).laser.power_drift_per_s = 0.0; }},
          {"background light", SilenceRoomLight},
          {"form and ruling of the grating", FlattenGrating},
          {"speckle", [](Scenario& s) { RotaryOf(s).grating.speckle_m = 0.0; }},
          {"moving air", [](Scenario& s) { RotaryOf(s).optics.wander_rad = 0.0; }},
          {"grating expansion", [](Scenario& s) { RotaryOf(s).grating.expansion_per_K = 0.0; }},
          {"expansion of the distances", SilenceDistances},
          {"growth of the posts", SilencePosts},
          {"bearings", SilenceBearings},
          {"vibration of the floor", [](Scenario& s) { RotaryOf(s).mechanics.vibration = "none"; }},
          {"noise of light and detectors", SilenceDetectors, true},
          {"amplifiers", SilenceAmplifiers, true},
          {"A/D converter", SilenceConverter, true},
          {"autocollimator", [](Scenario& s) { RotaryOf(s).autocollimator.noise_rad = 0.0; }}};
}

/// The effects of a scenario stand in a list that gets shorter where one before is taken out: found by what they
/// are.
Contribution OfEffect(const EffectSettings& effect) {
  const std::string name = "effect " + effect.name + (effect.where.empty() ? "" : " " + effect.where);
  return {name, [effect](Scenario& s) {
            std::erase_if(s.effects, [&](const EffectSettings& other) {
              return other.name == effect.name && other.where == effect.where &&
                     other.parameters == effect.parameters;
            });
          }};
}

}  // namespace

std::vector<Contribution> Contributions(const Scenario& scenario) {
  std::vector<Contribution> all = OfTheBench();
  for (const EffectSettings& effect : scenario.effects) all.push_back(OfEffect(effect));
  return all;
}

}  // namespace twinbench::benches::rotary
