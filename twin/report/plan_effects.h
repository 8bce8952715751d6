#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "twin/diagnose/diagnose.h"
#include "twin/plan/unseen.h"

namespace twinbench::report {

/// What a run would show of the bench's causes.
struct PlannedEffects {
  diagnose::DiagnosisRun seen;       // of the run's design, with its isolability
  std::vector<plan::Unseen> unseen;  // causes in the smallest sizes that would be found
  std::string refused = {};          // why no cause would be found, whatever its size; then there is nothing else
};

/// Sizes from which a test for a cause alone would find it, what each moves if it is left unseen at that size, and which others it
/// may be taken for.
std::string PlannedEffectsText(const PlannedEffects& effects);

/// `detectable`, `invisible`, `ties` and `never_told_apart` (docs/plan.md).
nlohmann::json PlannedEffectsJson(const PlannedEffects& effects);

}  // namespace twinbench::report
