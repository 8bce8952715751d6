#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "twin/diagnose/diagnosis.h"
#include "twin/plan/outlook.h"
#include "twin/plan/shift_sets.h"

namespace twinbench::report {

/// One run that could be made.
struct PlannedRun {
  std::string words;  // "as the scenario says", "4 set-ups, shifts 0, 1, 10, 28"
  std::optional<plan::ShiftSet> shifts;
  plan::Outlook outlook;
};

/// What the first run would give and would not see, and what the others would give instead.
/// @param seen  Of a run of the twin in order: sizes that would be found, causes that would not.
std::string PlanText(const std::vector<PlannedRun>& runs, const diagnose::Diagnosis& seen);
nlohmann::json PlanJson(const std::vector<PlannedRun>& runs, const diagnose::Diagnosis& seen);

/// "0, 1, 10, 28"
std::string ShiftList(const std::vector<int>& shifts);

}  // namespace twinbench::report
