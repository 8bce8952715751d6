#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/separate/position_error.h"

namespace twinbench::separate::harmonics {

using Positions = std::vector<const PositionError*>;

/// One order of all positions as a linear model: reading = x unknowns, with e_T of each direction and then psi.
struct OrderModel {
  Eigen::MatrixXcd x;  // positions x (directions + 1)
  Eigen::VectorXcd reading;
  Eigen::MatrixXd cov;  // of (re, im) of each reading
};

/// What the model leaves out of a position: the table's angle is read off by m, so that m comes out at a place that
/// is off by it. Root mean square of slope times that of the error, both taken from m: some milliarcsec at most.
double SecondOrder(const PositionError& position);

/// @param floor_rad  Added to the uncertainty of each position, by its index.
OrderModel ModelOrder(int order, const Positions& positions, const std::vector<int>& directions,
                      const std::vector<double>& floor_rad);

/// Weighted least squares in real numbers (re, im of each unknown); directions of the unknowns that change no
/// reading get nothing.
struct OrderSolution {
  Eigen::VectorXd x;
  Eigen::MatrixXd from_readings;  // x = from_readings * (re, im of the readings)
  double chi2 = kNaN;
  int dof = 0;
};

/// @param x  All of model.x, or some of its columns: the others are then taken as zero.
OrderSolution SolveOrder(const Eigen::MatrixXcd& x, const OrderModel& model);

/// What uncertain head angles add to the covariance of the readings: the head of a set-up moves all its readings
/// by -j k psi exp(-j k head), in both directions alike.
Eigen::MatrixXd HeadCovariance(int order, const Positions& positions, Complex psi, double u_head_rad);

/// Factor from equal noise on all readings to the worst transmission error; infinite if there is none.
double NoiseFactorOf(const Eigen::MatrixXcd& x);

}  // namespace twinbench::separate::harmonics
