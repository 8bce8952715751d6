#pragma once

#include "twin/separate/error_motion.h"

/// What of a contour is more than the noise that many angles of a turn have.
namespace twinbench::separate::rotary {

/// The contour of its constant, its order 1 and the orders that stand out of its noise (one in two hundred contours
/// of noise alone have one that does), at least the clearest one. The largest and smallest of hundreds of noisy
/// angles lie several standard deviations apart; those of a few orders do not. Each turn shows beside it what it
/// shows.
///
/// A contour of unknown covariance stays as it is.
/// @param motion  Angles evenly spread over one turn.
/// Uncertainty: that of the orders that are kept. Not included: orders that are there, but drown.
ErrorMotion OfStandingOrders(const ErrorMotion& motion);

}  // namespace twinbench::separate::rotary
