#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "twin/investigate/advice.h"

/// The loop closed: measure, diagnose, weigh the causes that are left over all runs so far, choose the run that
/// tells most per minute, measure again; until it is told, the budget is spent, or no run that the bench can make
/// tells more.
namespace twinbench::investigate {

struct InvestigationOptions {
  std::optional<Goal> goal;
  double budget_min = 120.0;  // of the procedures' own clocks
  double conclusive = 0.95;   // a cause of that probability is told, if it has no rival within a hundredth of it
  int most_runs = 20;
  /// Where nothing is found, the first run is made again until all of them together would show a cause of so many noise
  /// standard deviations in the first run; 0: the first run is believed. Not said: 2, and 0 where there is a goal.
  std::optional<double> faint;
};

/// A run that was chosen, and what was believed after it.
struct Step {
  int number = 1;
  plan::NextRun run;
  std::string reason;                                         // why this one, in words
  double minutes = 0.0;                                       // that it took
  double expected_bit = 0.0, gained_bit = 0.0;                // of which hypothesis is true
  std::vector<std::pair<std::string, double>> believed = {};  // name, probability; most probable first
  double unlisted = 0.0;
  double u_goal = 0.0;  // so far; NaN without a goal
};

/// Where its run is, in the folder of the investigation: "02-sweeps".
std::string FolderOf(const Step& step);

enum class Told { kNothing, kNamed, kTied, kUnknown };
enum class Ended { kTold, kBudget, kNothingMore, kDeclined };
const char* ToldName(Told told);     // "nothing", "named", "tied", "unknown"
const char* EndedName(Ended ended);  // "told", "budget spent", "nothing more can be told", "declined"

struct Investigation {
  std::vector<Step> steps;
  Belief belief;
  Told told = Told::kNothing;
  Ended ended = Ended::kTold;
  double minutes = 0.0;
  std::optional<Goal> goal;
  double u_goal = 0.0;               // NaN without a goal
  std::vector<std::string> refused;  // runs of the bench's list that cannot be planned, with the reason

  bool IsGoalMet() const { return !goal || u_goal <= goal->u; }
};

/// Who makes the runs and is told of them.
struct Laboratory {
  /// The readings of the run, by whatever makes them. @throws BenchError if it cannot.
  std::function<std::vector<Reading>(const Step&, const Scenario&)> measure;
  /// Whether it may be made; empty: it may.
  std::function<bool(const Step&, const std::vector<Advice>&)> confirm = {};
  /// After each step.
  std::function<void(const Investigation&)> told = {};
};

/// @param scenario  What is believed of the bench; its own run is the first. Where it leaves nothing to find causes by,
///     one that does comes next.
/// @throws InputError if no run can be diagnosed, or the first has no such quantity as the goal asks for.
Investigation Investigate(const Scenario& scenario, const InvestigationOptions& options, const Means& means,
                          const Laboratory& laboratory);

/// The scenario with what was told: the causes of the best hypothesis.
Scenario Extended(const Scenario& scenario, const Investigation& investigation);

}  // namespace twinbench::investigate
