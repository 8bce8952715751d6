#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/core/reading.h"
#include "twin/separate/even_inverse.h"

/// Front door of what separates curves that were read against each other at several shifts.
namespace twinbench::separate::shifts {

/// How the conjugate gradients ended.
struct Convergence {
  bool converged = false;
  int iterations = 0;
  /// What is left of the way to the solution, in the norm of the weighted fitted readings and of that of the readings;
  /// below 1e-12 is converged.
  double relative_error = kNaN;
};

struct ShiftSolution {
  /// a, b and the constants, in the order of EvenInverse, as the steps left them: they fit the readings, and have
  /// something in the directions that no reading tells.
  Eigen::VectorXd unknowns;
  Eigen::MatrixXd residuals;  // n x set-ups; NaN where nothing was read
  Convergence convergence;
};

/// Least squares of r_j(i) = a(i) + b(i + s_j) + constant of set-up j, for any shifts, missing readings and unequal
/// weights; b is another curve in every row of set-ups.
///
/// Solved by conjugate gradients on the normal equations (CGLS; Hestenes & Stiefel, J. Res. NBS 49 (1952) 409),
/// with the inverse of the evenly weighted, complete problem as preconditioner (EvenInverse). Where that is the
/// problem, one step solves it and a second takes the rounding out. Without gaps the number of steps depends on the
/// ratio of the weights in a set-up alone, not on n; q missing readings cost q steps at the most (2 % missing and
/// weights within a factor of ten: some sixty). A step costs two Fourier transforms of n and some passes through the
/// readings.
///
/// What is lost. Harmonics by the shifts (LostHarmonics), and of several rows what those of two rows differ by. By
/// missing readings: unknowns drawn at random are read and solved for again; a direction that does not come back is
/// lost. A set-up with a single reading tells nothing and counts as not read.
///
/// Limits. Two shifts see the lowest harmonic with n / 4 times the noise of the best, and rounding errors are noise
/// too.
class ShiftSeparation {
 public:
  /// @param shifts  Of each set-up, in stops.
  /// @param weight  n x set-ups: 1 / variance of each reading; 0 where there is none.
  /// @param most_steps  Of conjugate gradients, before they start again from the true residuals; four times at the
  /// most.
  /// @param rows  Of each set-up, from 0 on; empty: all the same.
  /// @throws std::logic_error if sizes contradict each other, a weight is negative or not finite, or nothing was
  /// read, or nothing of a row.
  ShiftSeparation(const std::vector<int>& shifts, Eigen::MatrixXd weight, int most_steps = 2000,
                  const std::vector<int>& rows = {});

  /// @param values  n x set-ups; what stands where the weight is 0 is not looked at.
  ShiftSolution Solve(const Eigen::MatrixXd& values) const;

  /// x of N x = right for a right-hand side in the range of the normal matrix N; the unknowns are EvenInverse's.
  Eigen::VectorXd SolveNormalEquations(const Eigen::VectorXd& right) const;

  /// Complete circles, each evenly weighted.
  bool IsEven() const { return even_; }
  /// Readings minus rank; NaN if more than eight directions are lost by missing readings.
  double dof() const { return dof_; }

 private:
  Eigen::MatrixXd Predict(const Eigen::VectorXd& x) const;
  Eigen::VectorXd Gather(const Eigen::MatrixXd& weighted) const;
  Eigen::VectorXd Minimise(const Eigen::MatrixXd& values, Convergence& convergence) const;
  void CountDegreesOfFreedom();
  Eigen::Index RowAt(Eigen::Index column) const;
  Eigen::Index CurveValues() const { return inverse_.curves() * n_; }

  Eigen::Index n_;
  int most_steps_;
  Eigen::MatrixXd weight_;
  std::vector<Eigen::Index> read_;  // set-ups that tell something
  EvenInverse inverse_;             // of these
  bool even_ = true;
  double dof_ = kNaN;
};

}  // namespace twinbench::separate::shifts
