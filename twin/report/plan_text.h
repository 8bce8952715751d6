#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "twin/plan/outlook.h"
#include "twin/plan/shift_sets.h"
#include "twin/report/plan_advice.h"
#include "twin/report/plan_effects.h"

namespace twinbench::report {

/// One run that could be made.
struct PlannedRun {
  std::string words;  // "as the scenario says", "4 mountings, shifts 0, 1, 10, 28"
  std::optional<plan::ShiftSet> shifts;
  plan::Outlook outlook;     // of one run, with the scenario's seed: what `check` says, and what that run then states
  plan::Outlook mean = {};   // over runs with other noise
  std::size_t mean_of = 1;   // so many
};

/// What the first run would give and would not see, and what the others, and the programme after it, would give.
/// @param effects    Of the first run.
/// @param programme  One or none.
std::string PlanText(const std::vector<PlannedRun>& runs, const PlannedEffects& effects, const std::vector<PlannedProgramme>& programme);
nlohmann::json PlanJson(const std::vector<PlannedRun>& runs, const PlannedEffects& effects);

/// What one run would give: u and U = 2 u of each result, and what is not separable.
std::string OutlookText(const plan::Outlook& outlook);
/// An entry of `runs`.
nlohmann::json OutlookJson(const PlannedRun& run);

/// "0, 1, 10, 28"
std::string ShiftList(const std::vector<int>& shifts);

}  // namespace twinbench::report
