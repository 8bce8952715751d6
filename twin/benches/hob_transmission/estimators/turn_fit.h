#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/separate/series.h"

namespace twinbench::separate::hob {

/// Fourier coefficients of one turn from samples wherever they are.
struct TurnFit {
  bool determined = false;  // false: everything else stays as it is
  double mean_rad = kNaN;   // order 0
  Eigen::VectorXcd value;   // [k - 1]: C_k [rad]
  Eigen::VectorXcd ramp;    // C_k of a ramp that rises by 1 over the turn, fitted from the same samples
  std::vector<Eigen::Matrix2d> cofactor;  // [k - 1]: cov of C_k by unit white noise of the samples
  double inflation = kNaN;      // largest variance of an order over that of as many samples at regular angles
  double residual_sum2 = kNaN;  // [rad^2]
  int samples = 0;
};

/// Fits orders 0 .. max_order by least squares to samples of one turn.
///
/// The samples need not be regular: a sum of harmonics up to max_order comes back exactly, whatever is missing, as
/// long as the fit is determined; interpolation would damp high orders instead, and a Fourier sum over the samples
/// that are there would mix orders. The normal matrix is Toeplitz, sum_i exp(j (k - l) th_i), so it costs
/// samples x 4 max_order operations and a decomposition of 2 max_order + 1 unknowns.
///
/// @param angle_rad  th of the samples, any turn.
/// @param value_rad  One a sample.
/// @param middle_rad Where the ramp is zero; `direction` (+1, -1) is the way it rises.
/// @return not determined with too few samples or a gap too wide for the highest orders.
///
/// Not included: content above max_order. Regular samples keep it out up to samples - max_order; with gaps a part
/// of it leaks into all orders. Reference: Groechenig, Math. Comp. 59 (1992) 181 (gaps below pi / max_order do).
TurnFit FitTurn(const Eigen::VectorXd& angle_rad, const Eigen::VectorXd& value_rad, double middle_rad,
                int direction, int max_order);

/// What orders 0 .. max_order leave of each column, by least squares; no columns if the samples do not determine them.
Eigen::MatrixXd BesideOrders(const Eigen::VectorXd& angle_rad, const Eigen::MatrixXd& columns, int max_order);

}  // namespace twinbench::separate::hob
