#include "twin/benches/rotary_4dof/estimators/table_part.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/core/linear_algebra.h"

namespace twinbench::separate {
namespace {

constexpr double kLost = 1e-6;  // part of a value's functional in a null direction

std::vector<Component> ComponentsOf(Table table, const std::vector<NotSeparable>& lost) {
  std::vector<Component> components = {Component::kEx, Component::kEy, Component::kEz, Component::kDx,
                                       Component::kDy};
  for (const NotSeparable& entry : lost) {
    if (entry.table != table || !entry.all) continue;
    for (const Component c : entry.components) std::erase(components, c);
  }
  return components;
}

Series SeriesOf(Table table, Component component) {
  const bool target = table == Table::kTarget;
  switch (component) {
    case Component::kEx:
      return target ? Series::kTargetEx : Series::kRefEx;
    case Component::kEy:
      return target ? Series::kTargetEy : Series::kRefEy;
    case Component::kEz:
      return target ? Series::kTargetEz : Series::kRefEz;
    case Component::kDx:
      return Series::kRefDx;
    default:
      return target ? Series::kTargetDy : Series::kRefDy;
  }
}

/// Factors from the units of the fit to SI, one a row of the part.
Eigen::VectorXd UnitsOf(const TablePart& part) {
  const auto n = static_cast<Eigen::Index>(part.position_rad.size());
  Eigen::VectorXd unit(n * std::ssize(part.components));
  for (std::size_t s = 0; s < part.components.size(); ++s) {
    unit.segment(n * static_cast<Eigen::Index>(s), n)
        .setConstant(IsAngle(part.components[s]) ? 1.0 : kLengthUnit_m);
  }
  return unit;
}

std::vector<double> Positions(const Design& design, Table table) {
  std::vector<double> position_rad;
  for (int i = 0; i < design.n; ++i) {
    position_rad.push_back(table == Table::kTarget ? design.TargetAngle_rad(i) : design.ReferenceAngle_rad(i));
  }
  return position_rad;
}

/// Rows without their parts in the orthonormal columns Q.
Eigen::MatrixXd Without(const Eigen::MatrixXd& Q, const Eigen::MatrixXd& rows) {
  return rows - Q * (Q.transpose() * rows);
}

/// P C P with P = I - Q Q^T.
Eigen::MatrixXd ProjectBothSides(const Eigen::MatrixXd& cov, const Eigen::MatrixXd& Q) {
  const Eigen::MatrixXd half = Without(Q, cov);
  return half - (half * Q) * Q.transpose();
}

void FindLostValues(const Eigen::MatrixXd& extra_null, TablePart& part) {
  if (extra_null.cols() == 0) return;
  const Eigen::MatrixXd left = Without(part.removed, extra_null(part.columns, Eigen::all));
  for (std::size_t r = 0; r < part.usable.size(); ++r) {
    if (left.row(static_cast<Eigen::Index>(r)).norm() > kLost) part.usable[r] = false;
  }
}

/// All but the covariance; every position counts as usable.
TablePart EmptyPart(const Design& design, Table table, const std::vector<NotSeparable>& lost) {
  TablePart part;
  part.table = table;
  part.components = ComponentsOf(table, lost);
  part.position_rad = Positions(design, table);
  for (const Component c : part.components) {
    for (int i = 0; i < design.n; ++i) part.columns.push_back(design.Column(SeriesOf(table, c), i));
  }
  part.usable.assign(part.columns.size(), true);
  return part;
}

/// What is taken out of one order of a table: orthonormal columns in the coefficients of its components
/// (LostBasis).
Eigen::MatrixXd LostOfOrder(const TablePart& part, const std::vector<NotSeparable>& lost, int order, int parts) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(parts * std::ssize(part.components), 0);
  for (const NotSeparable& entry : lost) {
    if (entry.table != part.table || entry.all) continue;
    std::vector<Eigen::Index> at;
    for (const Component c : entry.components) {
      at.push_back(parts *
                   (std::find(part.components.begin(), part.components.end(), c) - part.components.begin()));
    }
    for (const int signed_order : entry.orders) {
      if (std::abs(signed_order) != order) continue;
      const double sign = signed_order < 0 ? -1.0 : 1.0;
      columns.conservativeResize(Eigen::NoChange, columns.cols() + 2);
      auto added = columns.rightCols(2);
      added.setZero();
      added(at[0], 0) = 1.0;  // x: cos and -sin
      if (parts == 2) added(at[0] + 1, 1) = -sign;
      if (at.size() == 2 && parts == 2) added(at[1] + 1, 0) = sign;  // y: sin and cos
      if (at.size() == 2) added(at[1], 1) = 1.0;
    }
  }
  return columns.cols() == 0 ? columns : OrthonormalBasisOf(columns, 1e-9);
}

/// Empty columns of values and uncertainties, and both covariances.
TableEstimate Prepare(const TablePart& part, const Systematic& systematic) {
  TableEstimate estimate;
  estimate.components = part.components;
  estimate.cov = part.cov;
  estimate.second_order = systematic.second_order;
  estimate.cov_systematic = part.cov * systematic.second_order;
  if (systematic.d_calibration.cols() > 0) {
    const Eigen::MatrixXd shift =
        UnitsOf(part).asDiagonal() * Without(part.removed, systematic.d_calibration(part.columns, Eigen::all));
    estimate.cov_systematic.AddProduct(shift * CovarianceRootOf(systematic.cov_calibration));
  }
  estimate.value.position_rad = estimate.u.position_rad = part.position_rad;
  for (auto& column : estimate.value.value) column.assign(part.position_rad.size(), kNaN);
  estimate.u.value = estimate.value.value;
  return estimate;
}

}  // namespace

TablePart MakeTablePart(const Design& design, Table table, const std::vector<NotSeparable>& lost,
                        const NormalInverse& normal) {
  TablePart part = EmptyPart(design, table, lost);
  for (std::size_t r = 0; r < part.columns.size(); ++r) {
    part.usable[r] = normal.supported[static_cast<std::size_t>(part.columns[r])];
  }
  part.removed = LostBasis(table, lost, part.components, part.position_rad, part.usable);
  FindLostValues(normal.extra_null, part);
  const Eigen::VectorXd unit = UnitsOf(part);
  part.cov = CurveCovariance::Dense(unit.asDiagonal() *
                                    ProjectBothSides(normal.inverse(part.columns, part.columns), part.removed) *
                                    unit.asDiagonal());
  return part;
}

TablePart MakeTablePart(const Design& design, Table table, const std::vector<NotSeparable>& lost,
                        const OrderInverse& inverse) {
  TablePart part = EmptyPart(design, table, lost);
  part.removed = LostBasis(table, lost, part.components, part.position_rad, part.usable);
  std::vector<Series> series;
  for (const Component c : part.components) series.push_back(SeriesOf(table, c));
  std::vector<Eigen::MatrixXd> removed;
  for (int m = 0; 2 * m <= design.n; ++m) {
    removed.push_back(LostOfOrder(part, lost, m, OrderBasis(m, design.n).parts));
  }
  Eigen::MatrixXd lags = inverse.Lags(series, removed);
  const auto unit_of = [&](std::size_t s) { return IsAngle(part.components[s]) ? 1.0 : kLengthUnit_m; };
  for (std::size_t p = 0; p < series.size(); ++p) {
    for (std::size_t q = 0; q < series.size(); ++q) {
      lags.col(static_cast<Eigen::Index>(p * series.size() + q)) *= unit_of(p) * unit_of(q);
    }
  }
  part.cov = CurveCovariance::Circulant(std::move(lags), std::ssize(series));
  part.cov.AddProduct(UnitsOf(part).asDiagonal() *
                      Without(part.removed, inverse.Missing()(part.columns, Eigen::all)));
  return part;
}

TableEstimate EstimateTable(const TablePart& part, const Eigen::VectorXd& x, const Systematic& systematic) {
  TableEstimate estimate = Prepare(part, systematic);
  const std::size_t n = part.position_rad.size();
  const Eigen::VectorXd value = UnitsOf(part).cwiseProduct(Without(part.removed, x(part.columns)).col(0));
  for (std::size_t r = 0; r < part.columns.size(); ++r) {
    if (!part.usable[r]) continue;
    const auto row = static_cast<Eigen::Index>(r);
    estimate.value[part.components[r / n]][r % n] = value[row];
    const double variance = estimate.cov(row, row) + estimate.cov_systematic(row, row);
    estimate.u[part.components[r / n]][r % n] = std::sqrt(std::max(variance, 0.0));
  }
  return estimate;
}

}  // namespace twinbench::separate
