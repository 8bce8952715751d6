#pragma once

#include <string>
#include <vector>

#include "twin/core/scenario.h"
#include "twin/plan/next_run.h"

namespace twinbench::tools {

/// The runs as scenarios, one after the other behind the scenario's own: the same bench (`seed`), each another run of it (`repeat`), so that
/// what they measure is the same and its noise another each time.
std::vector<Scenario> ScenariosOf(const std::vector<plan::NextRun>& runs, const Scenario& scenario);

/// Before anything is written: every file of WriteNext.
/// @throws InputError as RequireFree.
void RequireFreeNext(const std::string& output, const std::vector<plan::NextRun>& runs, const std::string& scenario_file, bool force);

/// "next.toml" of a single run; "next-1-of-3-again.toml" and so on of several.
void WriteNext(const std::string& output, const std::vector<plan::NextRun>& runs, const Scenario& scenario);

}  // namespace twinbench::tools
