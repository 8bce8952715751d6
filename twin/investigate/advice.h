#pragma once

#include <string>
#include <vector>

#include "twin/investigate/evidence.h"
#include "twin/investigate/goal.h"

namespace twinbench::investigate {

/// A run that could be made next, and what is expected of it.
struct Advice {
  plan::NextRun run;
  double minutes = 0.0;
  double of_causes_bit = 0.0;  // about which hypothesis is true
  double of_goal_bit = 0.0;    // log2 of the goal's uncertainty before over after; 0 without a goal that is open
  double u_goal = 0.0;         // afterwards; NaN if it tells nothing of it
  double worth = 0.0;          // WorthOf: in runs like the first

  double PerMinute() const { return (of_causes_bit + of_goal_bit) / minutes; }
};

/// Runs of the bench's list as the twin would make them, made once.
class Plans {
 public:
  /// The scenario's own run once more comes first. A run that the bench or its evaluation refuses is left out.
  Plans(const Scenario& scenario, const Means& means);

  /// All that fit into the minutes, those that tell most per minute first.
  /// @param taken  Runs so far: one of the same kind tells nothing of what the catalogue lacks.
  std::vector<Advice> For(const Belief& belief, const Certainty* goal, const std::vector<TakenRun>& taken,
                          double minutes_left) const;

  /// Whether what the twin shows of that run leaves something to find causes by.
  bool CanBeDiagnosed(const plan::NextRun& run) const;

  const std::vector<std::string>& refused() const { return refused_; }

 private:
  struct Planned {
    TakenRun run;
    nlohmann::json results;
  };

  const Means& means_;
  std::vector<Planned> planned_;
  std::vector<std::string> refused_;  // "warm: ...", why
};

/// How much a run like `run` would tell of the open hypotheses [bit]. What the catalogue lacks and looks like the
/// best of them shows in a run of another kind in any size up to twice as large.
double OfCauses_bit(const Belief& belief, const TakenRun& run, bool is_of_another_kind, const Means& means);

}  // namespace twinbench::investigate
