#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "mechanics/pose_error.h"

namespace twinbench::mechanics {

/// Interpolates the components of an error motion over one turn by a periodic cubic spline.
///
/// A spline and not a trigonometric polynomial, because the angles need not be equally spaced, a wrong value stays
/// near its angle instead of ringing round the whole turn, and a look-up costs the same for 12 and for 720 angles.
/// Price: a harmonic of order k given at n angles is met only to about (k/n)^4 between them.
class PeriodicSpline {
 public:
  using Value = Eigen::Matrix<double, kErrorComponents, 1>;
  using Values = Eigen::Matrix<double, kErrorComponents, Eigen::Dynamic>;

  /// Zero everywhere.
  PeriodicSpline() = default;

  /// @param angle_rad  In any order, modulo a turn.
  /// @param values     One column an angle.
  /// @throws std::invalid_argument if a number is not finite or two angles are the same.
  PeriodicSpline(const std::vector<double>& angle_rad, const Values& values);

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

  static double Wrap(double angle_rad) { return angle_rad - kTurn * std::floor(angle_rad / kTurn); }
  std::size_t After(std::size_t i) const { return i + 1 == start_rad_.size() ? 0 : i + 1; }
  double Width(std::size_t i) const;
  std::vector<std::size_t> SortAngles(const std::vector<double>& angle_rad);
  /// Second derivatives at the angles, from continuity of the first (cyclic tridiagonal, positive definite).
  Values Curvatures(const Values& y) const;
  void MakePieces(const Values& y, const Values& curvature);

  std::vector<double> start_rad_;
  std::vector<Piece> pieces_;
};

}  // namespace twinbench::mechanics
