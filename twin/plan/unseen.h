#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "twin/core/scenario.h"

namespace twinbench::plan {

/// By how much a cause moves the results of one kind.
struct Bias {
  std::string name;      // "separation.target.ez_arcsec"
  double rms = 0.0;      // over its values, in the unit of the name
  double per_u = 0.0;    // over the root mean square of their standard uncertainties
};

/// A cause that stays unseen, and what it does meanwhile.
struct Unseen {
  std::string effect, where;
  EffectSettings as;  // in which size
  std::vector<Bias> biases;
  std::string not_known;  // why there are none
};

/// Changes of results that both documents have; by how many u they are moved, the most first.
std::vector<Bias> BiasesOf(const nlohmann::json& without, const nlohmann::json& with);

}  // namespace twinbench::plan
