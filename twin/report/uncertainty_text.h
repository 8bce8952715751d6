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

/// `uncertainty`: every quantity with its sources, u, degrees of freedom, k and U; `monte_carlo` if there were
/// trials.
nlohmann::json BudgetJson(const std::vector<uncertainty::Budget>& budgets, const uncertainty::MonteCarlo* trials);

/// A table a figure: what each contribution does alone and what is left without it, largest first.
std::string ContributionsText(const uncertainty::OneAtATime& found);
nlohmann::json ContributionsJson(const uncertainty::OneAtATime& found);

}  // namespace twinbench::report
