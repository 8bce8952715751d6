#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace twinbench::separate {

struct ErrorMotionReplicas {
  int number = 400;  // gives u to 3.5 %
  std::uint64_t seed = 1;
};

/// The normal numbers by which tests of error motions are repeated: drawn once for all sensitive directions, each of which scales them by its own
/// covariance and scatter.
class ErrorMotionDraws {
 public:
  /// Largest and smallest of standard normal numbers; one row an angle, one column a replica.
  struct Extremes {
    Eigen::MatrixXd most, least;
  };

  explicit ErrorMotionDraws(const ErrorMotionReplicas& replicas = {}) : replicas_(replicas) {}

  int number() const { return replicas_.number; }
  /// Standard normal numbers; one row an angle, one column a replica.
  const Eigen::MatrixXd& Contour(Eigen::Index angles);
  /// @param turns  How many numbers at each angle; all positive.
  const Extremes& Turns(const std::vector<int>& turns);

 private:
  ErrorMotionReplicas replicas_;
  Eigen::MatrixXd contour_;
  std::vector<int> turns_;  // of which extremes_ are
  Extremes extremes_;
};

}  // namespace twinbench::separate
