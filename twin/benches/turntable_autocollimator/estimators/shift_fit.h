#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "twin/benches/turntable_autocollimator/estimators/shift_convention.h"
#include "twin/benches/turntable_autocollimator/estimators/stops.h"
#include "twin/separate/curve_covariance.h"
#include "twin/separate/nearly_even_inverse.h"
#include "twin/separate/shift_separation.h"

namespace twinbench::separate::turntable {

/// The least-squares problem value = T(position) + R(tooth) + g(set-up) of a grid of stops, all readings of equal
/// weight, prepared once for any values.
///
/// Where the readings leave a choice, the mean of T is zero, so is that of every row of R, and what no shift tells
/// apart (LostHarmonics) is T's. The unknowns stand in the order [T; R].
///
/// It is ShiftSeparation with the teeth counted backwards: a tooth is the set-up's shift less the position. Complete
/// circles cost n log n; a stop that was missed or read more often than the others of its set-up costs some n more.
class ShiftFit {
 public:
  explicit ShiftFit(const StopGrid& grid);

  /// False if readings are missing so that more is lost than the shifts make it; all results are NaN then.
  bool determined() const { return determined_; }
  /// Readings minus rank.
  double dof() const { return dof_; }
  const StopGrid& grid() const { return grid_; }
  int common_steps() const { return common_steps_; }

  /// Unknowns for one value a grid stop; T and R at places that were not read are NaN.
  Eigen::VectorXd Solve(const Eigen::VectorXd& values) const;
  Eigen::VectorXd Residuals(const Eigen::VectorXd& values) const;
  /// Covariance of some unknowns, all of them read, for readings of unit variance.
  CurveCovariance Cofactor(const std::vector<int>& unknowns) const;

 private:
  Eigen::Index Setup(const GridStop& stop) const { return column_[static_cast<std::size_t>(stop.setup)]; }
  Eigen::MatrixXd CellMeans(const Eigen::VectorXd& values) const;
  bool ComesBack() const;
  Eigen::VectorXd Inverse(const Eigen::VectorXd& curves) const;
  Eigen::VectorXd CofactorColumn(int unknown) const;
  bool IsWholeCurve(const std::vector<int>& unknowns) const;
  CurveCovariance WholeCurve(int first) const;

  StopGrid grid_;
  int common_steps_ = 0;
  std::vector<Eigen::Index> column_;  // of each set-up among those that tell something; -1: tells nothing
  Eigen::MatrixXd readings_;          // of each stop and set-up
  std::optional<ShiftConvention> convention_;
  std::optional<shifts::ShiftSeparation> separation_;
  std::optional<shifts::NearlyEvenInverse> inverse_;  // none: too many stops differ
  double dof_ = kNaN;
  bool determined_ = false;
};

}  // namespace twinbench::separate::turntable
