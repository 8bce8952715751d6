#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "twin/uncertainty/budget.h"
#include "twin/uncertainty/joint.h"
#include "twin/uncertainty/monte_carlo.h"
#include "twin/uncertainty/one_at_a_time.h"

namespace twinbench::report {

/// A budget for each list of quantities (root mean squares over its places), largest source first; beside it what
/// the trials say, if there were any, and whether both say the same; then how results that are uncertain together go
/// together.
std::string BudgetText(const std::vector<uncertainty::Budget>& budgets,
                       const std::vector<uncertainty::Joint>& joints = {},
                       const uncertainty::MonteCarlo* trials = nullptr);

/// `uncertainty`: every quantity with its sources and sensitivities, u, degrees of freedom, k and U; `not_counted`:
/// what no result is computed with; `covariance`: of results that are uncertain together, propagated; `monte_carlo`
/// if there were trials, with their covariance and its regions of 95 %. A matrix of more than 400 rows is left out.
///
/// @param joints  With what the constants add (uncertainty::Combined).
nlohmann::json BudgetJson(const std::vector<uncertainty::Budget>& budgets,
                          const std::vector<uncertainty::Joint>& joints = {},
                          const uncertainty::MonteCarlo* trials = nullptr);

/// The budgets as the screen has them, for results.json: one for each list of quantities, root mean squares over
/// its places: [{name, values, u, k, U, sources: [{source, type, u, dof, share}]}], largest source first.
nlohmann::json BudgetsByList(const std::vector<uncertainty::Budget>& budgets);

/// A table a figure: what each contribution does alone and what is left without it, largest first.
std::string ContributionsText(const uncertainty::OneAtATime& found);
nlohmann::json ContributionsJson(const uncertainty::OneAtATime& found);

}  // namespace twinbench::report
