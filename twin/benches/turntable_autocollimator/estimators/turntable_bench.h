#pragma once

#include <optional>
#include <string>
#include <vector>

#include "twin/benches/turntable_autocollimator/estimators/equation_5.h"
#include "twin/benches/turntable_autocollimator/estimators/model_check.h"
#include "twin/core/estimator.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"

/// From readings of the bench turntable_autocollimator to all that is reported of them.
namespace twinbench::separate::turntable {

/// The stops of one phase, with what the scenario says of the autocollimator's scale taken out; readings without
/// numbers are left out.
std::vector<TurntableStop> StopsOf(const std::vector<Reading>& readings, const Scenario& scenario, Phase phase);

struct TurntableAnalysis {
  Estimator estimator = Estimator::kRigorous;
  int used = 0;      // readings of the full circle
  int left_out = 0;  // readings of any phase without numbers
  std::vector<TurntableStop> stops;  // of the full circle; x of those that were disturbed is NaN
  std::optional<IndexingSeparation> separation;
  /// Equation 5 on two set-ups of equal shift; empty if there are none. With the teeth in its uncertainties, and
  /// without any near a pole: INVALID.
  std::vector<PointwiseError> pointwise;
  std::optional<HarmonicModel> model;
  ErrorSize before;  // of the turntable at the positions
  std::optional<ModelCheck> check;
  std::string not_separated;  // why there is no separation or no model
};

/// @param estimator  kRigorous: the model follows the separated turntable. kPublished: it follows equation 5, at
///                   every position where both set-ups were read, poles included.
/// @throws InputError as SeparateIndexing.
/// Reference: Guo et al. (2014), sections 3 to 5.
TurntableAnalysis AnalyseTurntable(const std::vector<Reading>& readings, const Scenario& scenario,
                                   Estimator estimator);

}  // namespace twinbench::separate::turntable
