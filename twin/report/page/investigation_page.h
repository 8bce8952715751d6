#pragma once

#include <nlohmann/json_fwd.hpp>

#include "twin/report/page/run_page.h"

namespace twinbench::report {

/// An investigation: what was believed after every run, what each run told, how near the goal is.
/// @param investigation  investigation.json.
/// @param links          To the page of each step's run; empty: it has none.
Page InvestigationPage(const PageSource& source, const nlohmann::json& investigation, const std::vector<std::string>& links = {});

}  // namespace twinbench::report
