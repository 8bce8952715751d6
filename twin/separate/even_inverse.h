#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "twin/separate/fourier.h"
#include "twin/separate/shift_transfer.h"

namespace twinbench::separate::shifts {

/// A generalised inverse of the normal matrix of complete circles in which all readings of a set-up weigh the same,
/// harmonic by harmonic: n log n to apply.
///
/// Unknowns stand in one vector: a (n values), b (n values a row), then the constants of the set-ups. Each harmonic is
/// a block of its own, of a and the rows' b: with b eliminated, a has the weight sum over the rows of (W^2 - |S|^2) / W
/// (HarmonicTransfer); of a lost one a stays 0. The constants are eliminated (Schur complement). Directions whose
/// weight in it is below 1e-10 of the largest, or below what rounding leaves of it, count as lost.
class EvenInverse {
 public:
  explicit EvenInverse(ShiftSet set);

  Eigen::VectorXd Apply(const Eigen::VectorXd& right) const;

  /// Directions, besides the constants of the curves and lost harmonics, in which the curve a (or those of b) is
  /// lost: orthonormal columns, their means over the classes of stops (CommonDivisor) removed.
  const Eigen::MatrixXd& lost_of_a() const { return lost_of_a_; }
  const Eigen::MatrixXd& lost_of_b() const { return lost_of_b_; }
  /// Directions of all unknowns that change no reading.
  int null_directions() const { return null_directions_; }
  const ShiftSet& set() const { return set_; }
  int curves() const { return 1 + static_cast<int>(rows_.size()); }
  int unknowns() const { return curves() * set_.n + static_cast<int>(set_.shifts.size()); }

 private:
  Eigen::VectorXd InvertCurves(const Eigen::VectorXd& right) const;
  void SolveHarmonic(int order, std::vector<std::complex<double>>& wave) const;
  void EliminateConstants();
  void FindLostCurves(const Eigen::MatrixXd& null);

  ShiftSet set_;
  Fourier fourier_;
  std::vector<std::vector<HarmonicTransfer>> rows_;  // of each row
  std::vector<double> weight_of_a_;                  // each harmonic's, b eliminated; 0 if it is lost
  Eigen::MatrixXd eliminated_;        // InvertCurves of the constants' columns of the normal matrix
  Eigen::MatrixXd constant_inverse_;  // of the Schur complement
  Eigen::MatrixXd lost_of_a_, lost_of_b_;
  int null_directions_ = 0;
};

/// Takes the means of the classes i mod `classes` off the values that are to be used; the others become zero.
void RemoveClassMeans(int classes, const std::vector<bool>& used, Eigen::Ref<Eigen::VectorXd> values);

}  // namespace twinbench::separate::shifts
