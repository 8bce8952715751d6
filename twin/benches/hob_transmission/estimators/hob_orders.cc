#include "twin/benches/hob_transmission/estimators/hob_orders.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/hob_transmission/estimators/turn_fit.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"

namespace twinbench::separate::hob {
namespace {

constexpr double kLeastSeen = 0.05;  // of a wave's power, beside the orders of the table
constexpr Eigen::Index kDrift = 1;   // columns: the signal, a drift, and two a wave

Eigen::MatrixXd ColumnsOf(const Pass& pass, const std::vector<int>& orders) {
  const auto as_vector = [](const std::vector<double>& x) { return Eigen::Map<const Eigen::ArrayXd>(x.data(), std::ssize(x)); };
  const Eigen::ArrayXd th_rad = as_vector(pass.th_rad), hob_rad = as_vector(pass.hob_rad), value_rad = as_vector(pass.value_rad);
  Eigen::MatrixXd columns(th_rad.size(), 2 + 2 * std::ssize(orders));
  columns.col(0) = value_rad - value_rad.mean();
  columns.col(kDrift) = (th_rad - th_rad.mean()) / units::turn;
  for (Eigen::Index k = 0; k < std::ssize(orders); ++k) {
    columns.col(2 + 2 * k) = (orders[static_cast<std::size_t>(k)] * hob_rad).cos();
    columns.col(3 + 2 * k) = (orders[static_cast<std::size_t>(k)] * hob_rad).sin();
  }
  return columns;
}

/// Orders of the hob of which the table's leave enough.
std::vector<int> SeenOf(const std::vector<int>& orders, const Eigen::MatrixXd& columns, const Eigen::MatrixXd& beside) {
  std::vector<int> seen;
  for (Eigen::Index k = 0; k < std::ssize(orders); ++k) {
    const auto left = [&](Eigen::Index at) { return beside.col(at).squaredNorm() > kLeastSeen * columns.col(at).squaredNorm(); };
    if (left(2 + 2 * k) && left(3 + 2 * k)) seen.push_back(orders[static_cast<std::size_t>(k)]);
  }
  return seen;
}

}  // namespace

std::vector<HobOrder> TakeHobOrders(const TransmissionOptions& options, Pass& pass) {
  if (options.hob_orders.empty()) return {};
  const Eigen::VectorXd th_rad = Eigen::Map<const Eigen::VectorXd>(pass.th_rad.data(), std::ssize(pass.th_rad));
  const auto beside_orders = [&](const Eigen::MatrixXd& columns) { return BesideOrders(th_rad, columns, options.max_order); };
  Eigen::MatrixXd columns = ColumnsOf(pass, options.hob_orders), beside = beside_orders(columns);
  if (beside.cols() == 0) return {};
  const std::vector<int> seen = SeenOf(options.hob_orders, columns, beside);
  if (seen.size() < options.hob_orders.size()) {
    columns = ColumnsOf(pass, seen);
    beside = beside_orders(columns);
  }
  const Eigen::Index unknowns = columns.cols() - 1;
  const double dof = static_cast<double>(columns.rows() - unknowns - 2 * options.max_order - 1);
  if (seen.empty() || !(dof > 0.0)) return {};
  const Eigen::MatrixXd waves = beside.rightCols(unknowns);
  const Eigen::MatrixXd normal = waves.transpose() * waves;
  const Eigen::VectorXd x_rad = SolveSymmetric(normal, Eigen::VectorXd(waves.transpose() * beside.col(0)));
  const double variance = (beside.col(0) - waves * x_rad).squaredNorm() / dof;
  const Eigen::MatrixXd cofactor = InverseOfSymmetric(normal);
  std::vector<HobOrder> taken;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    const Eigen::Index at = kDrift + 2 * static_cast<Eigen::Index>(k);
    Eigen::Matrix2d cov = variance * cofactor.block<2, 2>(at, at);
    cov(0, 1) = cov(1, 0) = -cov(0, 1);  // C = a - j b
    taken.push_back({seen[k], {Complex(x_rad[at], -x_rad[at + 1]), cov}, dof});
  }
  Eigen::Map<Eigen::VectorXd>(pass.value_rad.data(), std::ssize(pass.value_rad)) -=
      columns.rightCols(unknowns - 1) * x_rad.tail(unknowns - 1);
  return taken;
}

std::vector<HobOrder> MeanOf(const std::vector<std::vector<HobOrder>>& all) {
  std::vector<HobOrder> mean;
  if (all.empty()) return mean;
  const auto count = static_cast<double>(all.size());
  for (const HobOrder& first : all.front()) {
    HobOrder sum{first.times, {0.0, Eigen::Matrix2d::Zero()}, 0.0};
    bool is_in_all = true;
    for (const std::vector<HobOrder>& own : all) {
      const auto found = std::ranges::find(own, first.times, &HobOrder::times);
      is_in_all = is_in_all && found != own.end();
      if (found == own.end()) continue;
      sum.wave.value += found->wave.value / count;
      sum.wave.cov += found->wave.cov / (count * count);
      sum.dof += found->dof;
    }
    if (is_in_all) mean.push_back(sum);
  }
  return mean;
}

}  // namespace twinbench::separate::hob
