#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "twin/benches/encoder_comparison/estimators/scale_steps.h"
#include "twin/benches/encoder_comparison/settings.h"
#include "twin/core/estimator.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/report/evaluation.h"

/// What Bench::evaluate and Bench::score have for runs of one kind.
namespace twinbench::benches::encoder {

// Runs in which a spindle coasts and the times of the ring's lines are read.

report::Evaluation EvaluateCoast(const Scenario& scenario, const std::vector<Reading>& readings,
                                 Estimator estimator);

/// @throws InputError if the readings give no curve.
report::ScoredRun ScoreCoast(const std::vector<Reading>& readings, const nlohmann::json& truth,
                             Estimator estimator);

// Runs in which several heads read the ring.

report::Evaluation EvaluateHeads(const Scenario& scenario, const std::vector<Reading>& readings,
                                 Estimator estimator);

/// Orders that no head tells are taken out of the truth; how large they were is said beside it.
/// @throws InputError if the readings give no curve.
report::ScoredRun ScoreHeads(const Scenario& scenario, const std::vector<Reading>& readings,
                             const nlohmann::json& truth, Estimator estimator);

/// The stops of an angle comparison evaluated as ISO 230-2 and VDI/DGQ 3441 do a rotary axis, for each set-up.
struct PositioningResults {
  nlohmann::json json;  // [{"setup", "axis": {"A": {"value_arcsec", "u_arcsec", "bias_arcsec"}, ...}, "targets",
                        // "u_parts", "missing", "notes"}]; empty without stops
  nlohmann::json vdi;   // [{"setup", "axis": {"P": {"value_arcsec", "u_arcsec", "bias_arcsec"}, ...}, "missing"}]
  std::string text;     // for a person; of many targets the values of the axis only
};

PositioningResults EvaluateStops(const std::vector<Reading>& readings, const DeviceSettings& device,
                                 const separate::encoder::ScaleSteps& steps);

}  // namespace twinbench::benches::encoder
