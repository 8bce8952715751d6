#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/estimators/head_fit.h"
#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"

namespace twinbench::separate::encoder {
namespace {

constexpr Eigen::Index kTogether = 256;  // rows
constexpr double kUndetermined = 1e-9;   // of the largest eigenvalue of the normal equations

}  // namespace

Eigen::RowVectorXd OrdersToFit::CurveRow(double angle_rad) const {
  Eigen::RowVectorXd row(2 * std::ssize(orders));
  const harmonics::Complex turn = std::polar(1.0, angle_rad);
  harmonics::Complex wave = 1.0;
  int reached = 0;
  for (std::size_t i = 0; i < orders.size(); ++i) {
    for (; reached < orders[i]; ++reached) wave *= turn;
    const auto at = 2 * static_cast<Eigen::Index>(i);
    row[at] = wave.real();
    row[at + 1] = -wave.imag();
  }
  return row;
}

Eigen::Index OrdersToFit::ColumnOf(int setup) const {
  return 2 * std::ssize(orders) + (std::ranges::lower_bound(setups, setup) - setups.begin());
}

HeadEquations::HeadEquations(OrdersToFit orders)
    : orders_(std::move(orders)),
      rows_(Eigen::MatrixXd::Zero(kTogether, orders_.Unknowns())),
      normal_(Eigen::MatrixXd::Zero(orders_.Unknowns(), orders_.Unknowns())),
      values_(Eigen::VectorXd::Zero(kTogether)),
      right_(Eigen::VectorXd::Zero(orders_.Unknowns())) {}

Eigen::RowVectorXd HeadEquations::RowOf(double angle_rad, int setup) const {
  Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(orders_.Unknowns());
  row.head(2 * std::ssize(orders_.orders)) = orders_.CurveRow(angle_rad);
  row[orders_.ColumnOf(setup)] = 1.0;
  return row;
}

void HeadEquations::Add(const Eigen::RowVectorXd& row, double value_rad) {
  if (waiting_ == kTogether) Gather();
  rows_.row(waiting_) = row;
  values_[waiting_++] = value_rad;
  ++count_;
}

void HeadEquations::Gather() {
  const auto rows = rows_.topRows(waiting_);
  normal_.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose());
  right_ += rows.transpose() * values_.head(waiting_);
  squares_rad2_ += values_.head(waiting_).squaredNorm();
  waiting_ = 0;
}

void HeadEquations::AddStop(const HeadStop& stop) {
  const auto heads = std::ssize(stop.values);
  Eigen::MatrixXd rows(heads, orders_.Unknowns());
  Eigen::VectorXd x_rad(heads);
  for (Eigen::Index j = 0; j < heads; ++j) {
    const HeadValue& value = stop.values[static_cast<std::size_t>(j)];
    rows.row(j) = RowOf(value.ring_rad, value.setup);
    x_rad[j] = value.x_rad;
  }
  const Eigen::RowVectorXd mean = rows.colwise().mean();
  const double mean_rad = x_rad.mean();
  for (Eigen::Index j = 0; j < heads; ++j) Add(rows.row(j) - mean, x_rad[j] - mean_rad);
  ++freed_;
}

void HeadEquations::AddFirstAgainstMean(const HeadStop& stop) {
  double mean_rad = 0.0;
  for (const HeadValue& value : stop.values) mean_rad += value.x_rad / static_cast<double>(stop.values.size());
  const HeadValue& first = stop.values.front();
  Add(RowOf(first.ring_rad, first.setup), first.x_rad - mean_rad);
}

void HeadEquations::AddPoint(double angle_rad, int setup, double value_rad) {
  Add(RowOf(angle_rad, setup), value_rad);
}

HeadSolution HeadEquations::Solve() {
  Gather();
  const auto [values, vectors] = EigenOfSymmetric(normal_);
  Require(values.allFinite(), "a symmetric matrix has eigenvalues");
  const double least = kUndetermined * values.tail(1).value();
  const Eigen::ArrayXd inverse = values.unaryExpr([least](double value) {
    return value > least ? 1.0 / value : 0.0;
  });
  HeadSolution solution;
  solution.cofactor = vectors * inverse.matrix().asDiagonal() * vectors.transpose();
  solution.x = solution.cofactor * right_;
  solution.rest_rad2 = std::max(0.0, squares_rad2_ - solution.x.dot(right_));
  solution.dof = count_ - freed_ - static_cast<double>((inverse > 0.0).count());
  return solution;
}

}  // namespace twinbench::separate::encoder
