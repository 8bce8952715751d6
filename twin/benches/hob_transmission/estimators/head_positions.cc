#include "twin/benches/hob_transmission/estimators/head_positions.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "twin/core/errors.h"
#include "twin/separate/order_model.h"

namespace twinbench::separate::hob {
namespace {

constexpr double kRounding_rad = 1e-13;  // of a hob angle of 1000 rad: readings without any noise have a weight

/// The positions that have orders, and what to do with them.
struct Used {
  Positions positions;
  std::vector<double> floor_rad;  // of each
  std::vector<int> directions;
  int highest = std::numeric_limits<int>::max();
  double dof = std::numeric_limits<double>::infinity();
};

Used PickUsed(const std::vector<PositionError>& positions) {
  Used used;
  for (const PositionError& position : positions) {
    if (position.status != PositionStatus::kOk) continue;
    used.positions.push_back(&position);
    used.floor_rad.push_back(std::hypot(kRounding_rad, SecondOrder(position)));
    used.highest = std::min(used.highest, position.series.Highest());
    used.dof = std::min(used.dof, position.series.dof);
  }
  for (const int d : {1, -1}) {
    const auto has = [d](const PositionError* p) { return p->direction == d; };
    if (std::any_of(used.positions.begin(), used.positions.end(), has)) used.directions.push_back(d);
  }
  return used;
}

Coefficient UnknownOf(const OrderSolution& solution, const Eigen::MatrixXd& cov, Eigen::Index i) {
  return {{solution.x[2 * i], solution.x[2 * i + 1]}, cov.block<2, 2>(2 * i, 2 * i)};
}

PositionSum SumOf(const OrderModel& model, Eigen::Index column) {
  PositionSum result{{0.0, Eigen::Matrix2d::Zero()}, 0.0};
  double count = 0.0;
  for (Eigen::Index r = 0; r < model.x.rows(); ++r) {
    if (model.x(r, column) == 0.0) continue;
    result.sum.value += model.reading[r];
    result.sum.cov += model.cov.block<2, 2>(2 * r, 2 * r);
    result.share += model.x(r, model.x.cols() - 1);
    ++count;
  }
  return {{result.sum.value / count, result.sum.cov / (count * count)}, result.share / count};
}

void FillParts(const OrderSolution& solution, const Eigen::MatrixXd& cov, const SeparationLimits& limits,
               SeparatedOrder& result) {
  const auto directions = std::ssize(result.sum);
  std::vector<Coefficient> transmission;
  double u_rad = 0.0;
  for (Eigen::Index d = 0; d < directions; ++d) {
    transmission.push_back(UnknownOf(solution, cov, d));
    u_rad = std::max(u_rad, LargestUncertainty(transmission.back()));
  }
  result.status = Judge(result.noise_factor, u_rad, limits);
  if (result.status != OrderStatus::kSeparated) return;
  result.transmission = std::move(transmission);
  result.encoder = UnknownOf(solution, cov, directions);
}

void FillTests(const OrderModel& model, const OrderSolution& solution, SeparatedOrder& result) {
  const OrderSolution alike = SolveOrder(model.x.leftCols(model.x.cols() - 1), model);
  result.chi2 = solution.chi2;
  result.dof = solution.dof;
  result.chi2_alike = alike.chi2;
  result.dof_alike = alike.dof;
}

SeparatedOrder SeparateOrder(int order, const Used& used, const HeadOptions& options) {
  const OrderModel model = ModelOrder(order, used.positions, used.directions, used.floor_rad);
  const OrderSolution solution = SolveOrder(model.x, model);
  const auto directions = std::ssize(used.directions);
  SeparatedOrder result{.order = order, .noise_factor = NoiseFactorOf(model.x)};
  result.transmission.resize(used.directions.size());
  for (Eigen::Index d = 0; d < directions; ++d) result.sum.push_back(SumOf(model, d));
  FillTests(model, solution, result);
  const Complex psi(solution.x[2 * directions], solution.x[2 * directions + 1]);
  const Eigen::MatrixXd cov = model.cov + HeadCovariance(order, used.positions, psi, options.u_head_rad);
  FillParts(solution, solution.from_readings * cov * solution.from_readings.transpose(), options.limits, result);
  return result;
}

}  // namespace

HeadSeparation SeparateHeads(const std::vector<PositionError>& positions, const HeadOptions& options) {
  const Used used = PickUsed(positions);
  HeadSeparation result;
  result.positions = static_cast<int>(used.positions.size());
  result.left_out = static_cast<int>(positions.size()) - result.positions;
  if (used.positions.empty()) return result;
  result.dof = used.dof;
  result.directions = used.directions;
  for (int k = 1; k <= used.highest; ++k) result.orders.push_back(SeparateOrder(k, used, options));
  return result;
}

HarmonicSeries TransmissionSeries(const HeadSeparation& separation, int direction) {
  const auto found = std::find(separation.directions.begin(), separation.directions.end(), direction);
  Require(found != separation.directions.end(), "this direction was not measured");
  const auto d = static_cast<std::size_t>(found - separation.directions.begin());
  HarmonicSeries series{.dof = separation.dof};
  for (const SeparatedOrder& order : separation.orders)
    series.orders.push_back(order.status == OrderStatus::kSeparated ? order.transmission[d] : order.sum[d].sum);
  return series;
}

HarmonicSeries EncoderSeries(const HeadSeparation& separation) {
  HarmonicSeries series{.dof = separation.dof};
  for (const SeparatedOrder& order : separation.orders) series.orders.push_back(order.encoder);
  return series;
}

}  // namespace twinbench::separate::hob
