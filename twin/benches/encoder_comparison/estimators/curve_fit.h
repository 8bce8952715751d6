#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/benches/encoder_comparison/estimators/passes.h"
#include "twin/separate/series.h"

namespace twinbench::separate::encoder {

/// Where the readings of a pass were taken on the device's scale [rad]; one vector a pass of the group.
using ScaleAngles = std::vector<Eigen::VectorXd>;

/// Angles of the turn that were read, to a ten-thousandth of it.
int DistinctAngles(const ScaleAngles& th_rad);

/// What one pass has besides the curve.
struct PassTerm {
  double constant_rad = kNaN;        // x in the middle of the pass and at its mean velocity, without the curve
  double slope_rad_per_turn = kNaN;  // in the sense of rising angles; NaN: one turn does not tell it from the curve
};

/// x = constant and slope of each pass + lag x velocity + orders 1 .. K, by least squares.
struct CurveFit {
  Eigen::VectorXcd value;                 // [k - 1]: C_k [rad]; empty: not even order 1 is determined
  std::vector<Eigen::Matrix2d> cofactor;  // [k - 1]: covariance of (re, im) of C_k by unit white noise
  std::vector<PassTerm> passes;
  double lag_s = kNaN;         // -x / velocity; NaN if the velocity does not vary within passes or is not known
  double lag_cofactor = kNaN;  // variance of lag_s by unit white noise
  double constant_cofactor = kNaN;        // the same of the mean of all constants
  std::vector<Eigen::VectorXd> rest_rad;  // x - fit, one vector a pass
  int dof = 0;

  int Highest() const { return static_cast<int>(value.size()); }
  double RestSum2() const;
};

/// The highest order, at most `most`, whose coefficients are no more uncertain than `max_inflation` x that of as
/// many readings at regular angles (variances), with a quarter of the readings to spare; 0: none. A gap narrower
/// than half a period of the highest order does no harm.
int HighestOrder(const PassGroup& group, const ScaleAngles& th_rad, int most, double max_inflation);

/// Fits orders 1 .. `highest`, which HighestOrder allows.
/// Not included: content above `highest`, which adds to the residuals and, at regular angles, to the order that
/// looks alike there (n - k for n angles).
CurveFit FitCurve(const PassGroup& group, const ScaleAngles& th_rad, int highest);

}  // namespace twinbench::separate::encoder
