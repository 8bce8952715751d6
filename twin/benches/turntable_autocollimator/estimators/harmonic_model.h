#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/benches/turntable_autocollimator/estimators/indexing.h"

/// The indexing error as a continuous curve (eq. 6 of Guo et al. 2014).
namespace twinbench::separate::turntable {

/// amplitude sin(order theta + phase).
struct HarmonicTerm {
  int order = 0;
  double amplitude_rad = kNaN;
  double phase_rad = kNaN;  // in (-pi, pi]
  double u_amplitude_rad = kNaN;
  double u_phase_rad = kNaN;  // first order: means little unless it is small
};

/// Variance of a number by what makes it uncertain.
struct SourceVariances {
  double readings = 0.0, roll = 0.0, teeth = 0.0;
};

struct CurvePoint {
  double value_rad = kNaN;
  double u_rad = kNaN;
};

/// a_0 + sum over k of a_k sin(k theta + alpha_k), k = 1 to the highest order.
struct HarmonicModel {
  int highest_order = 0;
  Eigen::VectorXd coefficients_rad;  // constant, then cos and sin of each order
  Eigen::MatrixXd cov_rad2;
  std::vector<HarmonicTerm> terms;
  std::vector<SourceVariances> of_amplitudes_rad2,
      of_phases_rad2;              // one a term, phase times amplitude; empty: not known
  double residual_rms_rad = kNaN;  // at the positions
  double u_unmodelled_rad = 0.0;  // what the residuals have beyond the series' uncertainty, as a standard deviation

  /// The error at any angle. Its uncertainty has u_unmodelled in it, but nothing of orders that n positions cannot
  /// show: order n - k looks like order k there.
  CurvePoint At(double turntable_rad) const;
};

/// [1, cos theta, sin theta, cos 2 theta, ...] up to an order.
Eigen::RowVectorXd HarmonicBasis(double angle_rad, int highest_order);

/// c cos(order theta) + s sin(order theta), and the covariance of c and s, as amplitude and phase.
HarmonicTerm TermOf(int order, const Eigen::Vector2d& cos_sin_rad, const Eigen::Matrix2d& cov_rad2);

/// Highest order that n positions determine, (n - 1) / 2.
int MostHarmonics(int positions);

/// Fits the orders 1 to `highest_order` by unweighted least squares; the uncertainty is propagated from the series.
/// A series without uncertainty (NaN) is taken to have independent noise of the size of the residuals.
/// @throws InputError if highest_order is negative or above MostHarmonics.
HarmonicModel FitHarmonics(const AngleSeries& series, int highest_order);

/// The highest order with the least corrected information criterion AICc (Hurvich and Tsai 1989), noise of unknown
/// size assumed. The correction keeps it from using up all positions. Of a circle that lacks positions 200 at the
/// most.
int ChooseHighestOrder(const AngleSeries& series);

}  // namespace twinbench::separate::turntable
