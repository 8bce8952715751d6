#include "twin/benches/circular_motion/twin/effects.h"

#include <cmath>
#include <functional>
#include <map>

#include "twin/sim/changed_keys.h"
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

/// What is no sum: waves whose azimuth moves, and a height that counts where none is stated.
const std::map<std::string, Change>& Changes() {
  static const std::map<std::string, Change> changes = {
      {"ball_form",
       [](auto& e, auto& s) {
         const std::size_t k = Parameter(e, "order") < 2.5 ? 0 : 1;
         AddWave(Parameter(e, "cosine"), Parameter(e, "sine"), static_cast<double>(k) + 2.0, s.bar.ball_m[k],
                 s.bar.ball_azimuth_rad[k]);
       }},
      {"eccentricity",
       [](auto& e, auto& s) {
         AddSineWave(e, 1.0, s.encoder.eccentricity_rad, s.encoder.eccentricity_azimuth_rad);
       }},
      {"ellipticity",
       [](auto& e, auto& s) { AddSineWave(e, 2.0, s.encoder.ellipticity_rad, s.encoder.ellipticity_azimuth_rad); }},
      {"tilt", [](auto& e, auto& s) {
         if (s.bar.height_m == 0.0) s.bar.height_m = Parameter(e, "height");
       }}};
  return changes;  // constant
}

CyclicError CyclicOf(const EffectSettings& e) {
  const double sine_m = Parameter(e, "sine"), cosine_m = Parameter(e, "cosine");
  return {AxisOf(e), std::hypot(sine_m, cosine_m), std::atan2(cosine_m, sine_m), Parameter(e, "pitch")};
}

}  // namespace

CircularSettings WithEffects(Scenario scenario) {
  ChangeKeys(scenario);
  CircularSettings& settings = CircularOf(scenario);
  for (const EffectSettings& effect : scenario.effects) {
    if (const auto change = Changes().find(effect.name); change != Changes().end())
      change->second(effect, settings);
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
