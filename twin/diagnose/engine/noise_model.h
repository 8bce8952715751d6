#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "twin/diagnose/engine/linear_run.h"
#include "twin/diagnose/engine/series_sums.h"

namespace twinbench::diagnose {

/// How the noise of the readings is believed to be: white with stated deviations, and what the data made us add.
/// Whitening divides each row by its deviation and takes out a first-order correlation from reading to reading
/// within one pass of one channel.
struct NoiseModel {
  Eigen::VectorXd sigma;  // by row, SI
  double rho = 0.0;       // correlation of neighbouring readings of a pass

  Eigen::MatrixXd Whiten(const LinearRun& run, const Eigen::MatrixXd& rows) const;
  /// The transpose of that map.
  Eigen::MatrixXd WhitenTransposed(const LinearRun& run, const Eigen::MatrixXd& white) const;
  /// That transpose times the map, of a run with one channel.
  Tridiagonal Precision(const LinearRun& run) const;
  Eigen::SparseMatrix<double, Eigen::RowMajor> Whiten(
      const LinearRun& run, const Eigen::SparseMatrix<double, Eigen::RowMajor>& rows) const;
};

}  // namespace twinbench::diagnose
