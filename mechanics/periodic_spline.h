#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace twinbench::mechanics {

/// Interpolates vectors of length N over one turn by a periodic cubic spline.
///
/// A spline and not a trigonometric polynomial, because the angles need not be equally spaced, a wrong value stays
/// near its angle instead of ringing round the whole turn, and a look-up costs the same for 12 and for 720 angles.
/// Price: a harmonic of order k given at n angles is met only to about (k/n)^4 between them.
template <int N>
class PeriodicSpline {
 public:
  using Value = Eigen::Matrix<double, N, 1>;
  using Values = Eigen::Matrix<double, N, Eigen::Dynamic>;

  /// Zero everywhere.
  PeriodicSpline() = default;

  /// @param angle_rad  In any order, modulo a turn.
  /// @param values     N x angles.
  /// @throws std::invalid_argument if a number is not finite or two angles are the same.
  PeriodicSpline(const std::vector<double>& angle_rad, const Values& values) {
    if (!values.allFinite()) throw std::invalid_argument("periodic spline: values must be finite");
    if (angle_rad.empty()) return;
    const std::vector<std::size_t> order = SortAngles(angle_rad);
    Values sorted(N, values.cols());
    for (std::size_t i = 0; i < order.size(); ++i) sorted.col(Index(i)) = values.col(Index(order[i]));
    MakePieces(sorted, Curvatures(sorted));
  }

  Value Evaluate(double unwrapped_rad) const {
    if (pieces_.empty()) return Value::Zero();
    const double wrapped_rad = Wrap(unwrapped_rad);
    const auto above = std::upper_bound(start_rad_.begin(), start_rad_.end(), wrapped_rad);
    const bool below_first = above == start_rad_.begin();
    const std::size_t i = (below_first ? start_rad_.size() : std::size_t(above - start_rad_.begin())) - 1;
    const double t = wrapped_rad - start_rad_[i] + (below_first ? kTurn : 0.0);
    const Piece& p = pieces_[i];
    return p.value + t * (p.slope + t * (p.half_curvature + t * p.sixth_jerk));
  }

 private:
  static constexpr double kTurn = 2.0 * std::numbers::pi;
  struct Piece {
    Value value, slope, half_curvature, sixth_jerk;
  };

  static Eigen::Index Index(std::size_t i) { return static_cast<Eigen::Index>(i); }
  static double Wrap(double angle_rad) { return angle_rad - kTurn * std::floor(angle_rad / kTurn); }
  std::size_t After(std::size_t i) const { return i + 1 == start_rad_.size() ? 0 : i + 1; }
  double Width(std::size_t i) const {
    return i + 1 == start_rad_.size() ? start_rad_[0] + kTurn - start_rad_[i] : start_rad_[i + 1] - start_rad_[i];
  }

  std::vector<std::size_t> SortAngles(const std::vector<double>& angle_rad) {
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

  /// Second derivatives at the angles, from continuity of the first (cyclic tridiagonal, positive definite).
  Values Curvatures(const Values& y) const {
    const std::size_t n = start_rad_.size();
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::Matrix<double, Eigen::Dynamic, N> right = Eigen::Matrix<double, Eigen::Dynamic, N>::Zero(Index(n), N);
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t j = After(i);
      const double h = Width(i);
      const Value slope = (y.col(Index(j)) - y.col(Index(i))) / h;
      for (std::size_t k : {i, j}) entries.emplace_back(int(k), int(k), h / 3.0);
      entries.emplace_back(int(i), int(j), h / 6.0);
      entries.emplace_back(int(j), int(i), h / 6.0);
      right.row(Index(i)) += slope.transpose();
      right.row(Index(j)) -= slope.transpose();
    }
    Eigen::SparseMatrix<double> matrix(Index(n), Index(n));
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
    return solver.solve(right).transpose();
  }

  void MakePieces(const Values& y, const Values& curvature) {
    for (std::size_t i = 0; i < start_rad_.size(); ++i) {
      const Value& m0 = curvature.col(Index(i));
      const Value& m1 = curvature.col(Index(After(i)));
      const double h = Width(i);
      const Value slope = (y.col(Index(After(i))) - y.col(Index(i))) / h - h / 6.0 * (2.0 * m0 + m1);
      pieces_.push_back({y.col(Index(i)), slope, 0.5 * m0, (m1 - m0) / (6.0 * h)});
    }
  }

  std::vector<double> start_rad_;
  std::vector<Piece> pieces_;
};

}  // namespace twinbench::mechanics
