#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/diagnose/diagnose.h"
#include "twin/plan/next_run.h"

namespace twinbench::investigate {

/// What an investigation asks of the bench's description (Bench), whatever bench it is.
struct Means {
  using Readings = std::vector<Reading>;

  std::function<diagnose::DiagnosisRun(const Readings&, const Scenario&, const std::vector<std::string>& struck)>
      diagnose;                                                                  // without the struck effects
  std::function<diagnose::LinearRun(const Readings&, const Scenario&)> against;  // readings beside a scenario
  std::function<nlohmann::json(const Readings&, const Scenario&)> evaluate;      // results.json
  std::function<Readings(const Scenario&)> twin;                                 // a run of the twin, for plans
  std::function<std::vector<plan::NextRun>(const Scenario&)> next_runs;
};

}  // namespace twinbench::investigate
