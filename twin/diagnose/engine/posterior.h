#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "twin/diagnose/engine/search.h"

namespace twinbench::diagnose {

using CauseKey = std::pair<std::string, std::string>;  // effect, where
using Share = std::pair<CauseKey, double>;             // of the posterior

/// One place of the search: what each cause, and all unknown shapes together, are worth there.
struct Posterior {
  std::map<CauseKey, double> named;  // posterior, all variants of a cause together
  double unknown = 0.0;
  int best_unknown = -1;  // most probable unknown family; negative: there is none
};
Posterior PosteriorOf(const Term& term, const std::vector<Family>& families);

/// The causes that share the place, most probable first: one alone if its probability is high enough, else the
/// smallest set that holds nearly all of what is not unknown.
std::vector<Share> CredibleSet(const Posterior& posterior);

/// The other causes, from `least` on, most probable first.
/// @param set  CredibleSet of the same.
std::vector<Share> Outside(const std::vector<Share>& set, const Posterior& posterior, double least);

}  // namespace twinbench::diagnose
