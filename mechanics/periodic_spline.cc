#include "mechanics/periodic_spline.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <numeric>
#include <stdexcept>

namespace twinbench::mechanics {
namespace {

Eigen::Index SplineIndex(std::size_t i) { return static_cast<Eigen::Index>(i); }

}  // namespace

PeriodicSpline::PeriodicSpline(const std::vector<double>& angle_rad, const Values& values) {
  if (!values.allFinite()) throw std::invalid_argument("periodic spline: values must be finite");
  if (angle_rad.empty()) return;
  const std::vector<std::size_t> order = SortAngles(angle_rad);
  Values sorted(kErrorComponents, values.cols());
  for (std::size_t i = 0; i < order.size(); ++i) sorted.col(SplineIndex(i)) = values.col(SplineIndex(order[i]));
  MakePieces(sorted, Curvatures(sorted));
}

double PeriodicSpline::Width(std::size_t i) const {
  return i + 1 == start_rad_.size() ? start_rad_[0] + kTurn - start_rad_[i] : start_rad_[i + 1] - start_rad_[i];
}

std::vector<std::size_t> PeriodicSpline::SortAngles(const std::vector<double>& angle_rad) {
  std::vector<double> wrapped_rad;
  for (double a : angle_rad) {
    if (!std::isfinite(a)) throw std::invalid_argument("periodic spline: angles must be finite");
    wrapped_rad.push_back(Wrap(a));
  }
  std::vector<std::size_t> order(angle_rad.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return wrapped_rad[a] < wrapped_rad[b]; });
  for (std::size_t i : order) start_rad_.push_back(wrapped_rad[i]);
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (Width(i) < 1e-9) throw std::invalid_argument("periodic spline: two angles are the same");
  }
  return order;
}

PeriodicSpline::Values PeriodicSpline::Curvatures(const Values& y) const {
  const std::size_t n = start_rad_.size();
  std::vector<Eigen::Triplet<double>> entries;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, kErrorComponents>;
  Rows right = Rows::Zero(SplineIndex(n), kErrorComponents);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t j = After(i);
    const double h = Width(i);
    const Value slope = (y.col(SplineIndex(j)) - y.col(SplineIndex(i))) / h;
    for (std::size_t k : {i, j}) entries.emplace_back(int(k), int(k), h / 3.0);
    entries.emplace_back(int(i), int(j), h / 6.0);
    entries.emplace_back(int(j), int(i), h / 6.0);
    right.row(SplineIndex(i)) += slope.transpose();
    right.row(SplineIndex(j)) -= slope.transpose();
  }
  Eigen::SparseMatrix<double> matrix(SplineIndex(n), SplineIndex(n));
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  return solver.solve(right).transpose();
}

void PeriodicSpline::MakePieces(const Values& y, const Values& curvature) {
  for (std::size_t i = 0; i < start_rad_.size(); ++i) {
    const Value& m0 = curvature.col(SplineIndex(i));
    const Value& m1 = curvature.col(SplineIndex(After(i)));
    const double h = Width(i);
    const Value slope = (y.col(SplineIndex(After(i))) - y.col(SplineIndex(i))) / h - h / 6.0 * (2.0 * m0 + m1);
    pieces_.push_back({y.col(SplineIndex(i)), slope, 0.5 * m0, (m1 - m0) / (6.0 * h)});
  }
}

}  // namespace twinbench::mechanics
