#pragma once

#include "twin/benches/turntable_autocollimator/diagnosis/places.h"
#include "twin/benches/turntable_autocollimator/diagnosis/signals.h"

namespace twinbench::diagnose::turntable {

/// What a reading shows of a small turn of the mirror about the turntable's axis, and of a small tilt upwards:
/// readings x axes.
struct Slopes {
  Eigen::MatrixXd of_turn, of_tilt;
};
/// Of an instrument that shows turns as x and tilts as y.
Slopes StraightSlopes(Eigen::Index readings);

/// What the readings may absorb without anything being wrong.
///
/// Local blocks: index error and tilt of the turntable at every position (two unknowns), and the beginning of every
/// sweep. Then, for each set-up, constants of x and y, and the tilt of the multi-tooth table's axis, which y shows
/// as a wave of its angle.
Nuisance FreeUnknowns(const Places& places, const Slopes& slopes, const Schedule& schedule);

/// The same with what is known to some extent behind them:
///  - teeth, where shifts tell them from positions: index error with its stated uncertainty, tilt of some seconds;
///  - second-order geometry of a tilted axis: x turns by products of two small tilts, once and twice a turn;
///  - the slope of the turntable's error along a sweep, as large as between its positions;
///  - the stated error of the camera's interpolation, whose phase nobody states;
///  - the thermometer's noise in a zero that follows the temperature.
/// @param per_K  How far both zeros follow it: readings x axes [rad/K].
Nuisance AllUnknowns(const Places& places, const Slopes& slopes, const SignalContext& context,
                     const Scenario& scenario, const Eigen::MatrixXd& per_K);

}  // namespace twinbench::diagnose::turntable
