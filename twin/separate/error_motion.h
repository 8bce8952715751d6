#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/core/reading.h"
#include "twin/separate/error_motion_draws.h"

/// Error motions of an axis of rotation in the terms of ISO 230-7 (and ANSI/ASME B89.3.4). Radial, axial or tilt: every number here has the
/// unit of what was put in, m or rad. The formulas are those in common use; the text of the standard was not at hand.
namespace twinbench::separate {

/// What a polar plot of the error motion is drawn about.
enum class PlotCentre {
  kLeastSquares,  // radial and tilt: centre of the least-squares circle; the once-per-turn part is where the artefact stands, no motion
  kPolarChart     // axial and face: the chart's own; the fundamental is a motion, and the residual is stated beside it
};

/// The error motion in one sensitive direction. Angles are spread over whole turns.
struct ErrorMotion {
  Eigen::VectorXd angle_rad;                 // n
  Eigen::VectorXd contour;                   // n: mean over the turns
  Eigen::MatrixXd cov;                       // n x n, of the contour; empty: not known
  std::vector<std::vector<double>> scatter;  // n lists: what each turn shows there - contour; empty lists: not known
};

/// The error motion of whole turns of an axis that were read at the same angles.
///
/// @param turns  One row a turn, one column an angle.
/// @throws std::logic_error unless there are a turn and a value an angle.
///
/// Uncertainty: of the contour, the scatter of all turns beside it, pooled over the angles; empty of one turn.
ErrorMotion OfTurns(const Eigen::VectorXd& angle_rad, const Eigen::MatrixXd& turns);

/// The error motion along a direction that turns: cos(angle) x + sin(angle) y at each angle (rotating sensitive direction, a tool that turns).
/// Its covariance is left empty.
/// @throws std::logic_error unless both have the same angles.
ErrorMotion Rotating(const ErrorMotion& x, const ErrorMotion& y);

/// Covariance of cos(angle) x + sin(angle) y.
/// @param cov  2 n x 2 n, x before y.
Eigen::MatrixXd RotatingCovariance(const Eigen::VectorXd& angle_rad, const Eigen::MatrixXd& cov);

/// A value of the plot and what scatter and uncertainty of the contour do to it.
struct ErrorMotionValue {
  double value = kNaN;
  double u = kNaN;     // standard uncertainty
  double bias = kNaN;  // about what they add to it; not taken off
};

struct ErrorMotionValues {
  ErrorMotionValue total;         // width of the ring that holds every turn
  ErrorMotionValue synchronous;   // width of the ring that holds the contour
  ErrorMotionValue asynchronous;  // largest width of the band of all turns at one angle; needs two turns
  ErrorMotionValue fundamental;   // kPolarChart: twice the amplitude of the once-per-turn part of the contour
  ErrorMotionValue residual;      // kPolarChart: width of the contour without it
  int turns = 0;                  // least number at an angle
  Eigen::VectorXd slope;          // d synchronous / d contour, n: what of the contour's uncertainty goes into it
};

/// Evaluates one sensitive direction. Widths are those of the points, not of a curve through them.
///
/// @return NaN what needs more than there is: scatter, covariances, three angles.
/// @throws std::logic_error if sizes differ or anything is not finite.
///
/// Uncertainty: values are largest minus smallest, which no derivative describes, so the test is repeated with random numbers: the contour
/// by its covariance, the turns at each angle as normal scatter of their own standard deviation. u is the standard deviation of what comes
/// out, bias its mean - value; of the asynchronous motion they are known without draws (WidestOf). Not included: that turns and contour vary
/// together (on the safe side); scatter that is not normal or runs on from angle to angle.
ErrorMotionValues EvaluateErrorMotion(const ErrorMotion& motion, PlotCentre centre, ErrorMotionDraws& draws);
ErrorMotionValues EvaluateErrorMotion(const ErrorMotion& motion, PlotCentre centre, const ErrorMotionReplicas& replicas = {});

}  // namespace twinbench::separate
