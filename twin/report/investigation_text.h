#pragma once

#include <string>
#include <vector>

#include "twin/investigate/investigation.h"

namespace twinbench::report {

/// One step: the run, why it was made, what was believed after it.
std::string StepText(const investigate::Step& step, const std::optional<investigate::Goal>& goal);

/// Runs to choose from, the one that tells most per minute first.
std::string AdviceText(const std::vector<investigate::Advice>& advice);

/// The end of it: the verdict in one line, each cause left with its sizes, the goal.
std::string InvestigationText(const investigate::Investigation& investigation, const std::string& bench);

}  // namespace twinbench::report
