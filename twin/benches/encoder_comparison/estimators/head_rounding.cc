#include <algorithm>
#include <cmath>
#include <map>

#include "twin/benches/encoder_comparison/estimators/head_fit.h"
#include "twin/core/rounding.h"

namespace twinbench::separate::encoder {
namespace {

/// Readings of the stops one below the other.
struct StackedHeads {
  Eigen::VectorXd ring_rad;
  Eigen::MatrixXd curve;  // a row each: the ring's error there by its orders
  Eigen::MatrixXd rows;  // how each reading's error enters the right side of the normal equations
  std::map<int, std::vector<std::pair<double, double>>> rest;  // by set-up: place of the ring, and what the fit leaves
};

Eigen::MatrixXd RowsOfStop(const HeadStop& stop, const OrdersToFit& orders) {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(std::ssize(stop.values), orders.Unknowns());
  for (Eigen::Index j = 0; j < rows.rows(); ++j) {
    const HeadValue& value = stop.values[static_cast<std::size_t>(j)];
    rows.row(j).head(2 * std::ssize(orders.orders)) = orders.CurveRow(value.ring_rad);
    rows(j, orders.ColumnOf(value.setup)) = 1.0;
  }
  return rows;
}

/// A head's error is in its own difference from the mean of all, and in the mean.
Eigen::MatrixXd Entering(const Eigen::MatrixXd& rows, StopRows which) {
  if (which == StopRows::kAllHeads) return rows.rowwise() - rows.colwise().mean();
  Eigen::MatrixXd first = -rows.row(0).replicate(rows.rows(), 1) / static_cast<double>(rows.rows());
  first.row(0) += rows.row(0);
  return first;
}

/// The curve by those of its orders that are no rounding.
Eigen::VectorXd OwnCurve(const HeadSolution& solution, Eigen::Index orders, double step_rad) {
  Eigen::VectorXd own = solution.x.head(2 * orders);
  for (Eigen::Index k = 0; k < own.size(); k += 2) {
    const double noise = solution.Variance_rad2() * solution.cofactor.block<2, 2>(k, k).trace();
    const double by_chance = solution.rounding.size() > 0 ? noise + solution.rounding.block<2, 2>(k, k).trace() : INFINITY;
    if (!IsOwnOrder(own.segment<2>(k).norm(), step_rad, by_chance)) own.segment<2>(k).setZero();
  }
  return own;
}

StackedHeads Stack(const HeadReadings& sorted, const OrdersToFit& orders, StopRows which, const HeadSolution& solution) {
  const Eigen::Index parts = 2 * std::ssize(orders.orders);
  StackedHeads all{Eigen::VectorXd(sorted.Values()), Eigen::MatrixXd(sorted.Values(), parts), Eigen::MatrixXd(sorted.Values(), orders.Unknowns()), {}};
  Eigen::Index at = 0;
  for (const HeadStop& stop : sorted.stops) {
    const Eigen::MatrixXd rows = RowsOfStop(stop, orders);
    const auto count = rows.rows();
    const double alone = std::sqrt(static_cast<double>(count) / (static_cast<double>(count) - 1.0));  // of its share of the mean
    Eigen::VectorXd rest = -rows * solution.x;
    for (Eigen::Index j = 0; j < count; ++j) rest[j] += stop.values[static_cast<std::size_t>(j)].x_rad;
    rest.array() -= rest.mean();
    for (Eigen::Index j = 0; j < count; ++j) {
      const HeadValue& value = stop.values[static_cast<std::size_t>(j)];
      all.ring_rad[at + j] = value.ring_rad;
      all.rest[value.setup].emplace_back(value.ring_rad, alone * rest[j]);
    }
    all.curve.middleRows(at, count) = rows.leftCols(parts);
    all.rows.middleRows(at, count) = Entering(rows, which);
    at += count;
  }
  return all;
}

}  // namespace

void AddRounding(const HeadReadings& sorted, const OrdersToFit& orders, StopRows which, const ScaleSteps& steps,
                 HeadSolution& solution) {
  if (!(steps.step_rad > 0.0)) return;
  const StackedHeads all = Stack(sorted, orders, which, solution);
  Visits visits, together;
  std::vector<std::pair<double, double>> of_all;
  for (const auto& [setup, rest] : all.rest) {
    visits.Add(rest, steps.step_rad);
    of_all.insert(of_all.end(), rest.begin(), rest.end());
  }
  together.Add(std::move(of_all), steps.step_rad);
  const double scatter_rad = visits.dof > 0.0 ? visits.Scatter_rad() : std::sqrt(solution.Variance_rad2());
  const double noise_rad = NoiseBehindRounding(steps.step_rad, std::sqrt(steps.at_once) * scatter_rad);
  solution.visits = visits.OfEach();
  solution.place_rad2 = RoundingOf(steps.step_rad, noise_rad, INFINITY).repeated;
  for (int round = 0; round < 2; ++round) {
    const Eigen::VectorXd shown_rad = all.ring_rad + all.curve * OwnCurve(solution, std::ssize(orders.orders), steps.step_rad);
    const Eigen::MatrixXd waves = RoundingWaves(shown_rad, steps.step_rad, noise_rad);
    const Eigen::MatrixXd moved = solution.cofactor * (all.rows.transpose() * waves);
    solution.rounding = moved * moved.transpose();
  }
  // Where heads pass the same places of the ring, their rounding is an error of the ring, which the reference has not.
  constexpr double kSame = 0.75;
  const bool same_places = together.places < kSame * visits.places;
  if (same_places) {
    solution.rounding.diagonal().array() += kSmearedPart * solution.place_rad2 * 2.0 / together.places;
    solution.place_rad2 = 0.0;
  } else {
    solution.rounding += kSmearedPart * solution.visits * solution.place_rad2 * solution.cofactor;
  }
}

void AddUnresolved(const HeadReadings& sorted, const OrdersToFit& orders, StopRows which,
                   const HeadSolution& solution, double step_rad, harmonics::HarmonicSeries& ring) {
  const StackedHeads all = Stack(sorted, orders, which, solution);
  FitRest left{.visible = (DistinctAngles({all.ring_rad}) - 1) / 2, .noise_dof = solution.dof, .step_rad = step_rad};
  double squares_rad2 = 0.0;
  for (const auto& [setup, of_head] : all.rest) {
    left.th_rad.emplace_back(std::ssize(of_head));
    left.rest_rad.emplace_back(std::ssize(of_head));
    for (std::size_t i = 0; i < of_head.size(); ++i) {
      left.th_rad.back()[static_cast<Eigen::Index>(i)] = of_head[i].first;
      left.rest_rad.back()[static_cast<Eigen::Index>(i)] = of_head[i].second;
    }
    squares_rad2 += left.rest_rad.back().squaredNorm();
  }
  // Of one head: what is solved for may be its difference from the others.
  left.white_rad2 = std::max(solution.Variance_rad2(), squares_rad2 / static_cast<double>(all.ring_rad.size()));
  const Unresolved unresolved = UnresolvedBy(ring, left);
  const Eigen::MatrixXd moved = solution.cofactor * (all.rows.transpose() * unresolved.Waves(all.ring_rad));
  for (std::size_t i = 0; i < orders.orders.size(); ++i) {
    const auto of_order = moved.middleRows<2>(2 * static_cast<Eigen::Index>(i));
    ring.At(orders.orders[i]).cov += of_order * of_order.transpose();
  }
  ring.unresolved_rad2 = unresolved.Variance_rad2();
}

}  // namespace twinbench::separate::encoder
