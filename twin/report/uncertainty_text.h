#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "twin/uncertainty/budget.h"
#include "twin/uncertainty/monte_carlo.h"
#include "twin/uncertainty/one_at_a_time.h"

namespace twinbench::report {

/// A budget for each list of quantities (root mean squares over its places), largest source first; beside it what
/// the trials say, if there were any.
std::string BudgetText(const std::vector<uncertainty::Budget>& budgets, const uncertainty::MonteCarlo* trials);

/// `uncertainty`: every quantity with its sources, u, degrees of freedom, k and U; `not_counted`: what no result is
/// computed with; `monte_carlo` if there were trials.
nlohmann::json BudgetJson(const std::vector<uncertainty::Budget>& budgets, const uncertainty::MonteCarlo* trials);

/// The budgets as the screen has them, for results.json: one for each list of quantities, root mean squares over
/// its places: [{name, values, u, k, U, sources: [{source, type, u, dof, share}]}], largest source first.
nlohmann::json BudgetsByList(const std::vector<uncertainty::Budget>& budgets);

/// A table a figure: what each contribution does alone and what is left without it, largest first.
std::string ContributionsText(const uncertainty::OneAtATime& found);
nlohmann::json ContributionsJson(const uncertainty::OneAtATime& found);

}  // namespace twinbench::report
