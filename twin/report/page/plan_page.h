#pragma once

#include <nlohmann/json_fwd.hpp>

#include "twin/report/page/run_page.h"

namespace twinbench::report {

/// A plan: what runs would give, order by order, which run to make next, what would be seen and what would be mistaken for what.
/// @param plan  What `plan --json` has written.
Page PlanPage(const PageSource& source, const nlohmann::json& plan);

}  // namespace twinbench::report
