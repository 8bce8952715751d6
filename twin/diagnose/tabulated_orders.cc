#include "twin/diagnose/tabulated_orders.h"

#include <algorithm>
#include <cmath>

#include "twin/core/linear_algebra.h"
#include "twin/diagnose/engine/candidates.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose {
namespace {

/// Those that the rows resolve.
std::vector<TwinComparison::TabulatedOrder> Resolved(const Compared& c, const TwinComparison& comparison) {
  const Schedule& rows = c.run.schedule;
  const int last = model::HighestOrder(model::TypicalStep_rad(rows, rows.target_rad));
  std::vector<TwinComparison::TabulatedOrder> orders = comparison.orders;
  std::erase_if(orders, [last](const auto& tabulated) { return tabulated.order > last; });
  return orders;
}

/// Waves of the orders, then the constants of the set-ups: groups of readings x columns.
Eigen::MatrixXd ColumnsOf(const Compared& c, const std::vector<TwinComparison::TabulatedOrder>& orders) {
  const Eigen::MatrixXd setups = model::Indicators(c.readings.setup);
  Eigen::MatrixXd columns(c.readings.Readings(), 2 * std::ssize(orders) + setups.cols());
  Eigen::Index at = 0;
  for (const auto& tabulated : orders)
    columns.middleCols(2 * at++, 2) = model::Wave(tabulated.order * c.readings.target_rad);
  columns.rightCols(setups.cols()) = setups;
  return c.groups.Mean(columns);
}

}  // namespace

std::vector<Harmonic> TabulateOrders(const Compared& c, const TwinComparison& comparison, const NoiseModel& noise) {
  const std::vector<TwinComparison::TabulatedOrder> orders = Resolved(c, comparison);
  if (orders.empty()) return {};
  const auto of_first = Eigen::seq(0, Eigen::last, c.run.Channels());
  const Eigen::VectorXd sigma = noise.sigma(of_first),
                        left = (c.run.residual + c.free.columns * c.free.values)(of_first);
  const Eigen::MatrixXd X = sigma.cwiseInverse().asDiagonal() * ColumnsOf(c, orders);
  const Eigen::VectorXd y = left.cwiseQuotient(sigma);
  const Eigen::MatrixXd inverse = GeneralInverseOf(X.transpose() * X);
  const Eigen::VectorXd x = inverse * (X.transpose() * y);
  const double scale2 = (y - X * x).squaredNorm() / std::max<double>(1.0, static_cast<double>(X.rows() - X.cols()));
  std::vector<Harmonic> table;
  Eigen::Index first = 0;
  for (const auto& tabulated : orders) {
    const Polar polar = PolarOf(x.segment<2>(first), scale2 * inverse.block<2, 2>(first, first));
    table.push_back(
        {tabulated.order, polar.size, polar.u_size, polar.phase_rad, polar.u_phase_rad, tabulated.meaning});
    first += 2;
  }
  return table;
}

}  // namespace twinbench::diagnose
