#pragma once

#include <map>
#include <memory>
#include <type_traits>

#include "twin/core/errors.h"
#include "twin/sim/effect_parameter.h"

namespace twinbench::sim {

/// Who carries out each effect of a bench's catalogue.
template <class Effect>
using EffectMakers = std::map<std::string, std::unique_ptr<Effect> (*)(const EffectSettings&, const Scenario&)>;

/// Makes an own class of it, of the effect's block or of block and scenario.
template <class Effect, class Own>
std::unique_ptr<Effect> Made(const EffectSettings& effect, const Scenario& scenario) {
  if constexpr (std::is_constructible_v<Own, const EffectSettings&, const Scenario&>)
    return std::make_unique<Own>(effect, scenario);
  else
    return std::make_unique<Own>(effect);
}

template <class Effect>
EffectMakers<Effect> Merged(EffectMakers<Effect> some, EffectMakers<Effect> others) {
  some.merge(others);
  return some;
}

/// @param effect  Checked against the catalogue by the scenario loader.
/// @throws std::logic_error if the catalogue has an effect that the twin has not.
template <class Effect>
std::unique_ptr<Effect> MakeBy(const EffectMakers<Effect>& makers, const EffectSettings& effect,
                               const Scenario& scenario) {
  const auto found = makers.find(effect.name);
  Require(found != makers.end(), "the catalogue has an effect that the twin has not");
  return found->second(effect, scenario);
}

}  // namespace twinbench::sim
