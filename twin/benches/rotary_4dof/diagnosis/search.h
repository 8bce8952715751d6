#pragma once

#include <memory>
#include <string>
#include <vector>

#include "twin/benches/rotary_4dof/diagnosis/rotary_case.h"
#include "twin/diagnose/diagnose.h"
#include "twin/diagnose/engine/analysis.h"

namespace twinbench::diagnose {

/// Causes that are decided before the search because they change the model itself, not its signals.
struct Discrete {
  std::string effect, where;
  double log_evidence = 0.0;
};

/// A model of the rotary bench with what the search found in it.
struct SearchedRotary {
  std::unique_ptr<rotary::RotaryCase> rotary;
  Analysis analysis;
  std::vector<Discrete> discrete;
};

/// Searches the bench as stated, or with the reference's wobble turning with the set-up where that explains more;
/// and again about the size of a cause that changes the bench so much that its signature bends.
/// @param model  What readings are compared with.
SearchedRotary SearchRotary(const std::vector<Reading>& readings, const Scenario& scenario,
                            const DiagnoseOptions& options, const rotary::ForwardModel& model);

}  // namespace twinbench::diagnose
