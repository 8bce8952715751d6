#include "twin/benches/turntable_autocollimator/parts_of_results.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "twin/benches/turntable_autocollimator/estimators/shift_fit.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"

namespace twinbench::benches::turntable {
namespace {

using separate::turntable::GridStop;
using separate::turntable::IndexingSeparation;
using separate::turntable::Readings;
using separate::turntable::Roll;
using separate::turntable::ShiftFit;
using separate::turntable::StopGrid;

constexpr std::size_t kMostPositions = 720;  // a covariance of more takes long to take the root of
constexpr int kOfCircle = 3;         // unknowns: centre and radius
constexpr const char* kStopsOnly = "the axis stood at every reading; the standard measures while it turns";
constexpr const char* kTeethInIt = "one shift of the teeth: what the multi-tooth table tilts is in it";

/// y along the turntable's axis where the crosshair is rolled by a known angle.
Eigen::VectorXd Upright(const Readings& readings, const Roll& roll) {
  if (!std::isfinite(roll.gamma_rad)) return readings.y_rad;
  return readings.x_rad * std::sin(roll.gamma_rad) + readings.y_rad * std::cos(roll.gamma_rad);
}

/// Without the least-squares circle of each set-up.
Eigen::VectorXd WithoutLean(const StopGrid& grid, const Eigen::VectorXd& y_rad) {
  Eigen::VectorXd rest_rad = y_rad;
  for (int setup = 0; setup < std::ssize(grid.setups); ++setup) {
    std::vector<Eigen::Index> rows;
    for (std::size_t k = 0; k < grid.stops.size(); ++k)
      if (grid.stops[k].setup == setup) rows.push_back(static_cast<Eigen::Index>(k));
    if (std::ssize(rows) < kOfCircle) continue;
    Eigen::MatrixXd circle(std::ssize(rows), kOfCircle);
    for (Eigen::Index r = 0; r < circle.rows(); ++r) {
      const double angle_rad = grid.Position_rad(grid.stops[static_cast<std::size_t>(rows[static_cast<std::size_t>(r)])].position);
      circle.row(r) << 1.0, std::cos(angle_rad), std::sin(angle_rad);
    }
    const Eigen::VectorXd own = y_rad(rows);
    rest_rad(rows) = own - circle * SolveLeastSquares(circle, own);
  }
  return rest_rad;
}

/// Of the contour, what it repeats to, and each pass.
report::DirectedMotion TiltOf(const StopGrid& grid, const ShiftFit& fit, const Eigen::VectorXd& y_rad, double of_noise) {
  const double readings = static_cast<double>(grid.stops.size()), dof = fit.dof() - (kOfCircle - 1.0) * static_cast<double>(grid.setups.size());
  report::DirectedMotion tilt{"tilt_fixed_x", true, {Eigen::VectorXd(grid.n), fit.Solve(y_rad).head(grid.n), {}, {}}};
  tilt.motion.scatter.resize(static_cast<std::size_t>(grid.n));
  for (int i = 0; i < grid.n; ++i) tilt.motion.angle_rad[i] = grid.Position_rad(i);
  if (!(dof > 0.0)) return tilt;
  tilt.dof = dof;
  const Eigen::VectorXd beyond = fit.Residuals(y_rad);
  for (std::size_t k = 0; k < grid.stops.size(); ++k)
    tilt.motion.scatter[static_cast<std::size_t>(grid.stops[k].position)].push_back(std::sqrt(readings / dof) * beyond[static_cast<Eigen::Index>(k)]);
  std::vector<int> positions(static_cast<std::size_t>(grid.n));
  for (int i = 0; i < grid.n; ++i) positions[static_cast<std::size_t>(i)] = i;
  tilt.motion.cov = beyond.squaredNorm() / dof * fit.Cofactor(positions).ToDense();
  const double variance = beyond.squaredNorm() / dof, share = variance > 0.0 ? std::min(1.0, of_noise / variance) : 1.0;
  tilt.parts = {{"noise", share * tilt.motion.cov}, {"repeatability", (1.0 - share) * tilt.motion.cov}};
  return tilt;
}

}  // namespace

report::ErrorMotionTexts EvaluateTilt(const std::vector<separate::turntable::TurntableStop>& stops, int positions,
                                      const IndexingSeparation& separation, double stated_noise_rad) {
  report::ErrorMotionTexts told;
  if (separation.turntable.position_rad.size() > kMostPositions) return told;
  const StopGrid grid = FindGrid(stops, positions);
  const ShiftFit fit(grid);
  const Eigen::VectorXd seen_rad = Collect(stops, grid).y_rad;
  if (!fit.determined() || seen_rad.isZero(0.0)) return told;  // or nobody saw a tilt
  const Eigen::VectorXd y_rad = WithoutLean(grid, Upright(Collect(stops, grid), separation.roll));
  const report::DirectedMotion tilt = TiltOf(grid, fit, y_rad, stated_noise_rad * stated_noise_rad);
  if (!tilt.motion.contour.allFinite()) return told;
  std::vector<std::string> missing = {kStopsOnly};
  if (separation.multitooth.position_rad.empty()) missing.emplace_back(kTeethInIt);
  separate::ErrorMotionDraws draws;
  AppendErrorMotions("turntable", {tilt}, missing, draws, told);
  return told;
}

}  // namespace twinbench::benches::turntable
