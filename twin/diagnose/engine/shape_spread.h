#pragma once

#include "twin/diagnose/engine/search.h"

namespace twinbench::diagnose {

/// Standard deviations by what the points of the grid explain: exp(explained / 2 variance) weighs them against the
/// fitted shape. Holds where slopes fail: a level between two readings, an onset, a second maximum, a lifetime that
/// trades against its amplitude. Zero if the grid is too coarse to have a second likely point. Of a long grid only
/// the part about the fitted shape is walked.
///
/// @param others    The other terms.
/// @param data      The residual, projected, with `others` taken out.
/// @param variance  Of the whitened noise.
struct Spread {
  Eigen::VectorXd amplitudes;  // of their best values from shape to shape
  Eigen::VectorXd shape;
};
Spread SpreadOverGrid(const Scanner& scanner, const Term& term, const LinearRun& run, const NoiseModel& noise,
                      const Projector& projector, const Deflation& others, const Projected& data, double variance);

}  // namespace twinbench::diagnose
