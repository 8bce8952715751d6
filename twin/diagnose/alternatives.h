#pragma once

#include <memory>
#include <vector>

#include "twin/diagnose/searched.h"

/// Effects without a size make another bench of it: readings decide which one they come from.
namespace twinbench::diagnose {

/// What is believed of a record, how well it fits, and what was decided to come there.
struct Belief {
  Scenario scenario;
  TwinComparison comparison;
  Compared compared;
  Misfit misfit;
  std::vector<Cause> decided;
};

Belief BelieveIn(const std::vector<Reading>& readings, const Scenario& scenario, const ComparisonOf& comparison_of,
                 const std::vector<Cause>& decided);

/// The one that leaves least, if it leaves next to nothing. The noise scale is free: only the ratio of the misfits
/// counts.
Belief WithoutBlunder(const std::vector<Reading>& readings, const ComparisonOf& comparison_of,
                      const std::vector<Alternative>& alternatives, Belief stated);

/// The search in what is believed, or in the alternative that explains more with all that was found in it. That it
/// has fewer unknowns is not counted in its favour.
std::unique_ptr<Searched> SearchAlternatives(const std::vector<Reading>& readings, const DiagnoseOptions& options,
                                             const ComparisonOf& comparison_of,
                                             const std::vector<Alternative>& alternatives, Belief& belief);

}  // namespace twinbench::diagnose
