#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/measure/measure.h"
#include "twin/measure/stability.h"
#include "twin/measure/verification.h"
#include "twin/separate/separate.h"

namespace twinbench::benches::rotary {

/// Everything that follows from readings and the scenario that describes them.
struct Analysis {
  measure::Estimator estimator = measure::Estimator::kRigorous;
  measure::Calibration calibration;
  std::vector<measure::Motion> motions;
  measure::Stability stability;        // readings = 0 without that phase
  measure::Verification verification;  // the same
  std::optional<separate::Separation> separation;
  std::string not_separated;  // why there is no separation
};

Analysis Analyse(const Scenario& scenario, const std::vector<Reading>& readings, measure::Estimator estimator);

/// results.json.
nlohmann::json ToJson(const Analysis& analysis);

}  // namespace twinbench::benches::rotary
