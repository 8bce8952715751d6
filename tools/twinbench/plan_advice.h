#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/twinbench/planned_run.h"
#include "twin/plan/advice.h"
#include "twin/plan/optimal_programme.h"
#include "twin/plan/shift_sets.h"
#include "twin/report/plan_advice.h"

namespace twinbench::tools {

/// The name of the run at the shifts that tell most.
inline constexpr const char* kBestShifts = "best-shifts";

/// What the scenario shifts; none if the bench, or this scenario, shifts nothing.
std::optional<plan::ShiftDesign> ShiftDesignOf(const Scenario& scenario);

/// A run that could be made, as its twin shows it.
struct LookedAt {
  plan::NextRun run;
  report::PlannedRun planned;
  nlohmann::json results;
  std::shared_ptr<const diagnose::Isolability> isolability = nullptr;  // null: its evaluation tells of no causes
  bool is_looked_at_for_causes = false;                                // else there was no time for it
};

/// The scenario's own run on the quick twin; its results alone.
LookedAt LookAtOwn(const Scenario& scenario);
LookedAt ResultsOfOwn(const Scenario& scenario);

/// All that the bench could do next: its own list, the same once more, and other shifts where something is shifted.
/// What bench or evaluation refuse is left out.
/// Results alone: LookAtCauses adds what each would tell of causes, which takes far longer.
/// @param setups  So many, where the bench's shifts are chosen anew.
/// @param share   Of the patience, until which runs are looked at.
std::vector<LookedAt> LookAtOthers(const Scenario& scenario, int setups, double share, Patience& patience);
void LookAtCauses(const Scenario& scenario, Patience& patience, std::vector<LookedAt>& others);

/// Additions that tell apart what the scenario's own run does not and a good set of shifts would: each on the quick
/// twin, those that take the fewest minutes more first, of equal ones those that know it best.
std::vector<report::Mending> Mendings(const Scenario& scenario, const LookedAt& own, Patience& patience);

/// What each buys, the most per minute first.
std::vector<plan::Advice> AdviceOf(const LookedAt& own, const std::vector<LookedAt>& others, const std::string& goal);

/// The runs that fit into the budget beside the scenario's own and tell most of the causes and results together.
report::PlannedProgramme ProgrammeOf(const LookedAt& own, const std::vector<LookedAt>& others,
                                     const report::PlanBudget& budget, const std::string& goal);

}  // namespace twinbench::tools
