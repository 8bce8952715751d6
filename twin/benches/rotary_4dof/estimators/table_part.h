#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/benches/rotary_4dof/estimators/normal_inverse.h"
#include "twin/benches/rotary_4dof/estimators/order_inverse.h"
#include "twin/benches/rotary_4dof/estimators/separate.h"

namespace twinbench::separate {

/// One table's part of the solution: which unknowns, which directions are removed, what covariance is left.
struct TablePart {
  Table table = Table::kTarget;
  std::vector<Component> components;
  std::vector<int> columns;          // of Design, stacked by component
  std::vector<bool> usable;          // false: no reading determines this value
  std::vector<double> position_rad;  // own angles
  Eigen::MatrixXd removed;           // orthonormal, see LostBasis
  CurveCovariance cov;               // random part after removal [rad^2, rad m, m^2]
};

TablePart MakeTablePart(const Design& design, Table table, const std::vector<NotSeparable>& lost,
                        const NormalInverse& normal);
/// The same order by order: everything is determined.
TablePart MakeTablePart(const Design& design, Table table, const std::vector<NotSeparable>& lost,
                        const OrderInverse& inverse);

/// What is not from the noise of the readings.
struct Systematic {
  Eigen::MatrixXd d_calibration;  // d unknowns / d (gains, rolls); no columns if the calibration is sure
  Matrix6 cov_calibration = Matrix6::Zero();
  double second_order = 0.0;  // variance of the model's second order, as a part of the random one
};

/// Values and uncertainties of one table from the unknowns `x` of the whole design.
TableEstimate EstimateTable(const TablePart& part, const Eigen::VectorXd& x, const Systematic& systematic);

}  // namespace twinbench::separate
