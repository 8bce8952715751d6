#pragma once

#include "tests/support/twin_run.h"
#include "twin/benches/names.h"
#include "twin/core/effect_catalogue.h"

/// Runs of the angle comparison with single effects, without noise unless asked for.
namespace twinbench::test {

inline Scenario EncoderScenario(const std::string& kind = "stops") {
  Scenario scenario;
  scenario.bench = kEncoderBench;
  EncoderOf(scenario).encoder_procedure.kind = kind;
  scenario.noise_free = true;
  return scenario;
}

/// An effect with the given parameters [SI]; the others are those of the catalogue.
inline EffectSettings EncoderEffect(const std::string& name, const std::map<std::string, double>& parameters = {}) {
  EffectSettings effect;
  effect.name = name;
  for (const EffectParameter& p : FindEffect(name, kEncoderBench)->parameters)
    effect.parameters[p.name] = p.default_SI;
  for (const auto& [parameter, value] : parameters) effect.parameters.at(parameter) = value;
  return effect;
}

inline std::vector<Reading> ReadingsWith(Scenario scenario, const EffectSettings& effect) {
  scenario.effects.push_back(effect);
  return RunEncoderTwin(scenario).readings;
}

}  // namespace twinbench::test
