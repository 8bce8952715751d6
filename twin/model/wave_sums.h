#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinbench::model {

/// Sums of readings over many waves at once,
///     sum_i y_i exp(i (first + g * step) phase_i),   g = 0 .. count - 1,
/// for phases that lie anywhere: a few times readings + count steps instead of readings x count.
///
/// Each reading is spread over the points about it on an even grid, the grid is transformed, and the width of the
/// spreading is divided out. Sums agree with direct ones to 1e-12 of sum |y|.
/// Reference: Barnett, Magland, af Klinteberg, SIAM J. Sci. Comput. 41 (2019) C479-C504 (type 1, exponential of a
/// semicircle).
class WaveSums {
 public:
  /// @param count  At least 1.
  WaveSums(const Eigen::VectorXd& phase_rad, double first, double step, int count);

  /// @param y  Readings x any.
  /// @return count x columns of y: sums with the cosine, and i times those with the sine.
  Eigen::MatrixXcd Of(const Eigen::MatrixXd& y) const;

 private:
  int count_, size_;
  Eigen::VectorXcd turned_;  // by reading: the wave in the middle of the sums
  std::vector<int> from_;    // by reading: the first of the points that it is spread over
  Eigen::MatrixXd share_;    // points x readings
  Eigen::VectorXd undo_;     // by sum: one over what the spreading leaves of it
};

}  // namespace twinbench::model
