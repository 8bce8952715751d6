#pragma once

#include <Eigen/Core>

namespace twinbench::diagnose::screen {

/// Allan variance of means over `length` samples in a row: half the mean square of the difference of neighbouring
/// means that do not overlap, within each series that was added.
///
/// White noise: variance / length. Flicker: the same at all lengths. Random walk and drift: growing.
/// Reference: Allan, Proc. IEEE 54 (1966) 221-230.
class AllanVariance {
 public:
  explicit AllanVariance(int length) : length_(length) {}

  /// @param series  One sample after the other, without a gap; a rest shorter than `length` is left out.
  void Add(const Eigen::VectorXd& series);

  double Pairs() const { return pairs_; }
  double Value() const;  // NaN without a pair

 private:
  int length_;
  double sum_ = 0.0, pairs_ = 0.0;
};

}  // namespace twinbench::diagnose::screen
