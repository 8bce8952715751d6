#pragma once

#include <string>
#include <vector>

#include "twin/benches/rotary_4dof/diagnosis/rotary_run.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"

/// Wires and labels: the first real-life cause of a model that does not fit, and loud enough to drown every other.
namespace twinbench::diagnose::rotary {

struct ConventionResult {
  std::string where;              // place of the effect `convention`, empty: none
  double log_evidence = 0.0;      // against taking the readings as they are
  std::vector<Reading> readings;  // as they should have been
};

/// Tries each swap, sign and index blunder of the catalogue on the readings and compares how well the free model
/// fits. Index and sense are judged by the commanded angles, the scenario's shifts and the direction of travel
/// alone.
ConventionResult ScreenConventions(const std::vector<Reading>& readings, const Scenario& scenario,
                                   const ForwardModel& model);

}  // namespace twinbench::diagnose::rotary
