#pragma once

#include <Eigen/Core>

/// What the steps in which an instrument shows its values leave in them. `noise` is the standard deviation of one
/// reading before it is rounded.
namespace twinbench {

/// The step of which all values are whole multiples apart; 0 if there is none that can be told. A few values off it
/// do not count: those before a restart.
double CommonStep(const Eigen::VectorXd& values);

/// Variance over all places of what rounding leaves in the mean of many readings, in squares of its step: 1/12
/// without noise. Its error at a place is a saw-tooth, whose waves the noise dims: sum over k of (1 / pi k)^2 / 2
/// exp(-(2 pi k noise)^2) (Widrow & Kollar, Quantization Noise, 2008, 5).
/// @param noise  In steps.
double RepeatedByRounding(double noise);

/// Variance by rounding in the mean of several readings of one place.
struct RoundingInMean {
  double repeated = 0.0;  // what is in each of them alike
  double all = 0.0;       // that and what is left of the rest
};
/// @param noise  Like `step` in any unit, whose square the result has.
RoundingInMean RoundingOf(double step, double noise, double count);

/// Root mean square of the largest structure that rounding alone may leave: of all of it without noise, and with noise as
/// the fundamental of a saw-tooth that is smoothed falls.
/// @param scatter  Of a reading, with what rounding adds to it; like `step` in any unit, which the result has.
double LargestByRounding(double step, double scatter);

/// The noise of readings that, rounded, scatter by so much at one place (standard deviation, all places pooled): the
/// scatter is noise and that part of step^2 / 12 that does not repeat. 0 where rounding hides it.
double NoiseBehindRounding(double step, double scatter);

/// The saw-tooth at places that show `values`, as waves of unknown phase: columns W with W W^T the covariance of what
/// repeats at these places, where the zero of the scale may lie anywhere in its step. Places a whole number of steps
/// apart err alike.
Eigen::MatrixXd RoundingWaves(const Eigen::VectorXd& values, double step, double noise);

}  // namespace twinbench
