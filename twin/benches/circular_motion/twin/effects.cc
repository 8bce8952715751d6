#include "twin/benches/circular_motion/twin/effects.h"

#include <cmath>
#include <functional>
#include <map>

#include "twin/sim/effect_parameter.h"

namespace twinbench::sim {
namespace {

std::size_t AxisOf(const EffectSettings& effect) {
  return effect.where == "y" ? 1 : 0;
}

/// Adds cosine * cos(order a) + sine * sin(order a) to amplitude * cos(order (a - azimuth)).
void AddWave(double cosine, double sine, double order, double& amplitude, double& azimuth_rad) {
  cosine += amplitude * std::cos(order * azimuth_rad);
  sine += amplitude * std::sin(order * azimuth_rad);
  amplitude = std::hypot(cosine, sine);
  azimuth_rad = std::atan2(sine, cosine) / order;
}

/// The same of amplitude * sin(order (a - azimuth)), a quarter of a period behind.
void AddSineWave(const EffectSettings& e, double order, double& amplitude, double& azimuth_rad) {
  AddWave(Parameter(e, "sine"), -Parameter(e, "cosine"), order, amplitude, azimuth_rad);
}

using Change = std::function<void(const EffectSettings&, CircularSettings&)>;

const std::map<std::string, Change>& MachineChanges() {
  static const std::map<std::string, Change> changes = {
      {"scale", [](auto& e, auto& s) { s.machine.scale[AxisOf(e)] += Parameter(e, "error"); }},
      {"squareness", [](auto& e, auto& s) { s.machine.squareness_rad += Parameter(e, "angle"); }},
      {"straightness", [](auto& e, auto& s) { s.machine.bow_m[AxisOf(e)] += Parameter(e, "bow"); }},
      {"backlash", [](auto& e, auto& s) { s.machine.backlash_m[AxisOf(e)] += Parameter(e, "width"); }},
      {"thermal_growth", [](auto& e, auto& s) { s.machine.expansion_per_K[AxisOf(e)] += Parameter(e, "growth"); }},
      {"servo_lag",
       [](auto& e, auto& s) {
         for (double& lag_s : s.machine.lag_s) lag_s += Parameter(e, "lag");
       }},
      {"servo_mismatch", [](auto& e, auto& s) {
         s.machine.lag_s[0] += 0.5 * Parameter(e, "lag");
         s.machine.lag_s[1] -= 0.5 * Parameter(e, "lag");
       }}};
  return changes;  // constant
}

const std::map<std::string, Change>& InstrumentChanges() {
  static const std::map<std::string, Change> changes = {
      {"bar_expansion", [](auto& e, auto& s) { s.bar.expansion_per_K += Parameter(e, "growth"); }},
      {"bar_gain", [](auto& e, auto& s) { s.bar.gain_error += Parameter(e, "gain"); }},
      {"bar_nonlinearity", [](auto& e, auto& s) { s.bar.cubic_per_m2 += Parameter(e, "cubic"); }},
      {"ball_form",
       [](auto& e, auto& s) {
         const std::size_t k = Parameter(e, "order") < 2.5 ? 0 : 1;
         AddWave(Parameter(e, "cosine"), Parameter(e, "sine"), static_cast<double>(k) + 2.0, s.bar.ball_m[k],
                 s.bar.ball_azimuth_rad[k]);
       }},
      {"encoder_latency", [](auto& e, auto& s) { s.encoder.latency_s += Parameter(e, "latency"); }},
      {"eccentricity",
       [](auto& e, auto& s) {
         AddSineWave(e, 1.0, s.encoder.eccentricity_rad, s.encoder.eccentricity_azimuth_rad);
       }},
      {"ellipticity",
       [](auto& e, auto& s) { AddSineWave(e, 2.0, s.encoder.ellipticity_rad, s.encoder.ellipticity_azimuth_rad); }},
      {"tilt",
       [](auto& e, auto& s) {
         s.encoder.tilt_rad[0] += Parameter(e, "tilt_x");
         s.encoder.tilt_rad[1] += Parameter(e, "tilt_y");
         if (s.bar.height_m == 0.0) s.bar.height_m = Parameter(e, "height");
       }},
      {"grid_scale", [](auto& e, auto& s) { s.grid.scale[AxisOf(e)] += Parameter(e, "error"); }},
      {"grid_shear", [](auto& e, auto& s) { s.grid.shear_rad += Parameter(e, "angle"); }}};
  return changes;  // constant
}

CyclicError CyclicOf(const EffectSettings& e) {
  const double sine_m = Parameter(e, "sine"), cosine_m = Parameter(e, "cosine");
  return {AxisOf(e), std::hypot(sine_m, cosine_m), std::atan2(cosine_m, sine_m), Parameter(e, "pitch")};
}

}  // namespace

CircularSettings WithEffects(CircularSettings settings, const std::vector<EffectSettings>& effects) {
  for (const EffectSettings& effect : effects) {
    for (const auto* changes : {&MachineChanges(), &InstrumentChanges()}) {
      if (const auto change = changes->find(effect.name); change != changes->end())
        change->second(effect, settings);
    }
  }
  return settings;
}

void AddToMachine(const std::vector<EffectSettings>& effects, CircleMachine& machine) {
  for (const EffectSettings& e : effects) {
    if (e.name == "cyclic") machine.Add(CyclicOf(e));
    if (e.name == "reversal_spike")
      machine.Add(ReversalSpike{AxisOf(e), Parameter(e, "height"), Parameter(e, "time")});
  }
}

}  // namespace twinbench::sim
