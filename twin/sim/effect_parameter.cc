#include "twin/sim/effect_parameter.h"

#include "twin/core/errors.h"

namespace twinbench::sim {

double Parameter(const EffectSettings& effect, const char* name) {
  const auto found = effect.parameters.find(name);
  Require(found != effect.parameters.end(), "an effect lacks a parameter of the catalogue");
  return found->second;
}

}  // namespace twinbench::sim
