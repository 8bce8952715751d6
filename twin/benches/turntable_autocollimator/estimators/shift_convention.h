#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/separate/even_inverse.h"

namespace twinbench::separate::turntable {

/// What is chosen where the readings leave a choice between the curves of a ShiftSeparation: what no shift tells
/// apart is a's, and a and every row of b have zero mean, over the values that were read.
///
/// A linear map of all curves (a and the rows of b, n values each) to curves that fit the readings as well.
class ShiftConvention {
 public:
  /// @param read  Of every value of the curves.
  ShiftConvention(const shifts::ShiftSet& set, std::vector<bool> read);

  Eigen::VectorXd Applied(const Eigen::VectorXd& curves) const;
  /// The transposed map.
  Eigen::VectorXd Transposed(const Eigen::VectorXd& curves) const;

  bool Read(Eigen::Index value) const { return read_[static_cast<std::size_t>(value)]; }
  bool AllRead() const;

 private:
  Eigen::Index ClassOf(Eigen::Index value) const;
  std::vector<double> ClassSums(const Eigen::VectorXd& curves, Eigen::Index from, Eigen::Index to) const;
  void MoveToA(Eigen::VectorXd& curves) const;
  void MoveToATransposed(Eigen::VectorXd& curves) const;
  void RemoveMeans(Eigen::VectorXd& curves, Eigen::Index from) const;

  Eigen::Index n_;
  int classes_;
  int rounds_;                  // of MoveToA and the rows' means, until both are true at once
  std::vector<int> row_shift_;  // of a set-up of each row
  std::vector<bool> read_;
  std::vector<double> teeth_;  // of each class
};

}  // namespace twinbench::separate::turntable
