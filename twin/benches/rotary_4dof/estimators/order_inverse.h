#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "twin/benches/rotary_4dof/estimators/order_blocks.h"
#include "twin/benches/rotary_4dof/estimators/weights.h"

namespace twinbench::separate {

/// The generalised inverse of NormalInverse for circles of which little is missing: one block of at most 18 + 4
/// set-ups unknowns for each order, and a product of low rank for the stops that were left out or weigh less than
/// others of their set-up (Woodbury). For complete circles it makes the same choices in the directions that change
/// no reading, so that it is the same matrix. It costs n blocks and is applied by Fourier transforms in n log n; a
/// stop that is missing adds four columns.
class OrderInverse {
 public:
  /// @return nothing if more than an eighth of the stops is missing or weighs less, if a stop weighs more than its
  ///         set-up's heaviest in some direction, or if what is missing leaves something open.
  static std::optional<OrderInverse> Of(const Design& design, const std::vector<OrderBlock>& blocks,
                                        const std::vector<Cell>& cells);

  /// Inverse times columns of one value an unknown (Design).
  Eigen::MatrixXd operator*(const Eigen::MatrixXd& right) const;
  void Scale(double variance);

  /// Variances of the predicted motions of each cell.
  std::vector<Vector4> FittedVariances(const std::vector<Cell>& cells, const std::vector<StopModel>& models) const;

  /// Covariance by lag of some series among each other (CurveCovariance::Circulant), without Missing().
  /// @param removed  For each order orthonormal columns in the coefficients of these series (series * parts + part)
  ///                 that are taken out.
  Eigen::MatrixXd Lags(const std::vector<Series>& series, const std::vector<Eigen::MatrixXd>& removed) const;

  /// F of the product F F^T that the missing weight adds to the inverse; a row an unknown.
  const Eigen::MatrixXd& Missing() const { return missing_; }

 private:
  OrderInverse(const Design& design, const std::vector<OrderBlock>& blocks) : design_(design), blocks_(blocks) {}
  Eigen::MatrixXd TimesWithoutGaps(const Eigen::MatrixXd& right) const;
  std::vector<Vector4> FittedWithoutGaps() const;
  bool TakeOut(const Eigen::MatrixXd& lacking);

  Design design_;
  std::vector<OrderBlock> blocks_;
  std::vector<Eigen::MatrixXd> inverse_;  // of each block, in its columns
  Eigen::MatrixXd missing_;
};

}  // namespace twinbench::separate
