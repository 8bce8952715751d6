#pragma once

#include <string>
#include <vector>

#include "twin/benches/turntable_autocollimator/diagnosis/places.h"
#include "twin/benches/turntable_autocollimator/diagnosis/signals.h"
#include "twin/core/reading.h"
#include "twin/model/follow.h"

/// The forward model of a turntable that is checked with a multi-tooth table, a mirror and an autocollimator (Guo
/// et al. 2014), with the effects that the scenario already knows.
namespace twinbench::diagnose::turntable {

struct TurntableRun {
  LinearRun run;  // channels "x" and "y", in arcsec
  SignalContext context;
  Places places;
  int left_out = 0;          // readings without a value
  Eigen::MatrixXd body_rad;  // readings x axes: turn and tilt of the mirror by the free unknowns
  Eigen::ArrayX<bool> is_shown;  // rows: the twin predicts a reading there
};

/// x = T(position) + R(tooth) + constant of the set-up; y = tilt of the turntable(position) + constant + wave of
/// the multi-tooth table's angle; both turned by the stated roll and stretched by the stated gain error. The
/// calibration is a sweep of the turntable alone about one position: x follows its steps, and its error is taken as
/// one unknown and a slope, which a smooth error has over some minutes of arc.
///
/// Noise: autocollimator, and the scatter of both tables at a stop; the multi-tooth table is lifted at each.
///
/// @param follow  The twin that is asked what readings should have been, with the errors of tables and mountings
/// that
///                fit best.
/// @throws InputError if fewer than 12 readings have both values.
TurntableRun BuildRun(const std::vector<Reading>& readings, const Scenario& scenario,
                      const model::FollowMaker& follow);

/// The run of `scenario`, linearised where effects that were `found` put it: a ripple shifts its own argument, and
/// what readings show of a small change. The effects themselves are still in the residual.
/// @param found  Effects that are added behind the optics.
TurntableRun LinearisedAbout(const std::vector<EffectSettings>& found, const std::vector<Reading>& readings,
                             const Scenario& scenario, const model::FollowMaker& follow);

/// What unknowns that follow a cause would do to the results: "turntable ez up to 0.4 arcsec rms".
std::string BiasInWords(const Places& places, const Eigen::VectorXd& unknowns);

}  // namespace twinbench::diagnose::turntable
