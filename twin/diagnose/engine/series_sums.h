#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinbench::diagnose {

/// A symmetric matrix of which only the diagonal and what stands near it are not zero.
struct Banded {
  Eigen::VectorXd diagonal;
  std::vector<Eigen::VectorXd> beside;  // entry i of the k-th joins i and i + k + 1; the last ones are zero
};

/// Sums over all readings of the series of a grid, S for all grid points at once, where there is a quicker way to
/// them than to write every series out.
class SeriesSums {
 public:
  virtual ~SeriesSums() = default;

  /// S'Y: the columns of one grid point after the other x columns of Y.
  virtual Eigen::MatrixXd Products(const Eigen::MatrixXd& Y) const = 0;

  /// S'TS of the columns of each grid point.
  virtual std::vector<Eigen::MatrixXd> Squares(const Banded& T) const = 0;
};

}  // namespace twinbench::diagnose
