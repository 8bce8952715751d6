#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "twin/core/scenario.h"

namespace twinbench::tools {

/// What a plan is asked for beside the scenario.
struct PlanWish {
  int setups = 0;                        // how many there may be; 0: as many as the scenario has
  double minutes = 0.0, readings = 0.0;  // budget for further runs, by one of the two; 0: none
  std::string goal;                      // the result that counts: "target.ez"; empty: all
  double cpu_s = 0.0;                    // from which on less is looked at; 0: no end
};

struct PlanMade {
  nlohmann::json json;             // as `plan --json`
  std::vector<Scenario> next;      // the runs to be made next, as `plan -o` writes them
};

/// `twinbench plan` for other programs.
/// @throws InputError as the command.
PlanMade MakePlan(const Scenario& scenario, const PlanWish& wish);

}  // namespace twinbench::tools
