#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/measure/measure.h"

namespace twinbench::tools {

/// What the readings of any bench come to.
struct Evaluation {
  nlohmann::json results;     // results.json
  nlohmann::json separation;  // separation.json (formats.md); null if there is none
  std::string not_separated;  // why
  std::string summary;        // for a person

  bool Separated() const { return !separation.is_null(); }
};

Evaluation Evaluate(const Scenario& scenario, const std::vector<Reading>& readings, measure::Estimator estimator);

/// Compares a run of the twin with its truth.
struct ScoredRun {
  nlohmann::json json;
  std::string text, positions;  // for a person; `positions`: one row a position
};

/// @throws InputError if the run has nothing to compare.
ScoredRun ScoreRun(const Scenario& scenario, const std::vector<Reading>& readings, const nlohmann::json& truth,
                   measure::Estimator estimator);

}  // namespace twinbench::tools
