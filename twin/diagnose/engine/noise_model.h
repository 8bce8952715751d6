#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "twin/diagnose/engine/autoregression.h"
#include "twin/diagnose/engine/linear_run.h"
#include "twin/diagnose/engine/scan_kernels.h"
#include "twin/diagnose/engine/series_sums.h"

namespace twinbench::diagnose {

/// Rows of a run that are looked at by themselves: those of one channel, or all.
struct RowsOf {
  Eigen::Index first = 0, stride = 1;
};

/// How the noise of the readings is believed to be: white with stated deviations, and what the data made us add.
/// Whitening divides each row by its deviation and takes out what the readings before it in the same pass of the same
/// channel say of it.
struct NoiseModel {
  Eigen::VectorXd sigma;  // by row, SI
  Autoregression memory;  // of rows divided by it

  Eigen::MatrixXd Whiten(const LinearRun& run, const Eigen::MatrixXd& rows) const;
  /// The same of some rows of the run, which are all that `rows` has.
  RunsByRow Whiten(const LinearRun& run, const Eigen::MatrixXd& rows, RowsOf which) const;
  /// The transpose of that map.
  Eigen::MatrixXd WhitenTransposed(const LinearRun& run, const Eigen::MatrixXd& white) const;
  /// That transpose times the map, of a run with one channel.
  Banded Precision(const LinearRun& run) const;
  Eigen::SparseMatrix<double, Eigen::RowMajor> Whiten(
      const LinearRun& run, const Eigen::SparseMatrix<double, Eigen::RowMajor>& rows) const;
};

/// By row, how many rows of its channel stand before it in its pass; no more than `most`.
std::vector<int> RowsBefore(const LinearRun& run, std::size_t most);

}  // namespace twinbench::diagnose
