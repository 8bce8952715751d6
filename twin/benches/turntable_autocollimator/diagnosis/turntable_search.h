#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "twin/benches/turntable_autocollimator/diagnosis/turntable_run.h"
#include "twin/core/scenario.h"
#include "twin/diagnose/diagnosis.h"
#include "twin/diagnose/engine/analysis.h"

namespace twinbench::diagnose::turntable {

/// A searched run and all that its analysis refers to.
struct SearchedTurntable {
  std::unique_ptr<TurntableRun> turntable;
  std::unique_ptr<std::vector<Family>> families;
  Analysis analysis;
  std::optional<NoiseCause> outlying;  // single values that were left out before
  std::vector<Cause> first;            // multitooth_seating, if that is at work: it is no signature
  double smallest_seating_rad = kNaN;  // that would have been seen
};

/// The search, without values very far outside. A ripple that is found moves its own argument, so that the run is
/// linearised again about it; where x scatters too much at every lift, this is noise that is known from then on,
/// and the search begins again.
///
/// @param excluded  Effects taken out of the catalogue.
/// @param follow  The twin that is asked what readings should have been.
SearchedTurntable SearchTurntable(const std::vector<Reading>& readings, const Scenario& scenario,
                                  const std::vector<std::string>& excluded, const AnalysisOptions& options,
                                  const model::FollowMaker& follow);

}  // namespace twinbench::diagnose::turntable
