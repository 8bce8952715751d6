#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "twin/benches/rotary_4dof/estimators/measure.h"
#include "twin/benches/rotary_4dof/estimators/method_bias.h"
#include "twin/benches/rotary_4dof/estimators/separate.h"
#include "twin/benches/rotary_4dof/estimators/stability.h"
#include "twin/benches/rotary_4dof/estimators/verification.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"

namespace twinbench::benches::rotary {

/// Everything that follows from readings and the scenario that describes them.
struct Analysis {
  Estimator estimator = Estimator::kRigorous;
  measure::Calibration calibration;
  std::vector<measure::Motion> motions;
  measure::Stability stability;        // readings = 0 without that phase
  measure::Verification verification;  // the same
  std::optional<separate::Separation> separation;
  separate::MethodBias method_bias;  // of the published equations, which it is part of the uncertainty of
  std::string not_separated;         // why there is no separation
};

Analysis Analyse(const Scenario& scenario, const std::vector<Reading>& readings, Estimator estimator);

/// results.json.
nlohmann::json ToJson(const Analysis& analysis);

}  // namespace twinbench::benches::rotary
