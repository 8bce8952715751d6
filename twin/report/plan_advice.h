#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "twin/plan/advice.h"
#include "twin/plan/optimal_programme.h"

namespace twinbench::report {

/// "0.17", "2.9", "36": a short run takes no 0 minutes.
std::string MinutesText(double minutes);

/// An addition that separates what a run does not.
struct Mending {
  plan::NextRun run;
  double more_minutes = 0.0;         // than the scenario's own
  double minutes = 0.0;
  double dof = 0.0;                  // that are left then
  std::vector<std::string> mended;   // "target dy"
  std::vector<std::string> words = {};  // the same with what no shifts tell of it: "target dy but for order 0"
  std::vector<plan::Gain> certain;   // results that it adds: name, and in `ratio` their rms u in the unit of the name
};

/// What a programme may take, the scenario's own run not counted.
struct PlanBudget {
  double amount = 0.0;
  bool in_readings = false;  // else minutes
};

struct PlannedProgramme {
  PlanBudget budget;
  std::vector<plan::Advice> runs;  // what was chosen from, in the order of `best.times`
  plan::Programme best;            // D-optimal
  plan::Programme least_trace;     // A-optimal
  std::vector<plan::Gain> gains;   // of all results: the scenario's own run and the D-optimal ones together
  int unknowns = 0;
  bool is_of_results_alone = false;  // what some run tells of causes is not known
};

std::string MendingText(const std::vector<Mending>& mendings);
nlohmann::json MendingJson(const std::vector<Mending>& mendings);

/// Runs in order of what they buy per minute.
std::string PlanAdviceText(const std::vector<plan::Advice>& advice);
nlohmann::json PlanAdviceJson(const std::vector<plan::Advice>& advice);

std::string ProgrammeText(const PlannedProgramme& programme);
nlohmann::json ProgrammeJson(const PlannedProgramme& programme);

}  // namespace twinbench::report
