#include "twin/benches/turntable_autocollimator/estimators/roll.h"

#include <cmath>

#include "twin/core/distributions.h"
#include "twin/core/linear_algebra.h"

namespace twinbench::separate::turntable {
namespace {

constexpr double kLeastSignal = 4.0;  // mean square of y over what noise alone leaves

/// Equal noise of x and y that scatters the residuals about a line: orthogonal regression.
AutocollimatorNoise NoiseOfResiduals(const Eigen::VectorXd& x_rad, const Eigen::VectorXd& y_rad, double dof) {
  if (dof < 1.0 + kLeastDof) return {};
  Eigen::Matrix2d squares;
  squares << x_rad.squaredNorm(), x_rad.dot(y_rad), x_rad.dot(y_rad), y_rad.squaredNorm();
  const double least = EigenvaluesOfSymmetric(squares)[0];
  const double u_rad = std::sqrt(std::max(least, 0.0) / (dof - 1.0));
  return {u_rad, u_rad, static_cast<int>(std::lround(dof - 1.0))};
}

}  // namespace

double Roll::Correct(double x_rad, double y_rad) const {
  return x_rad * std::cos(gamma_rad) - y_rad * std::sin(gamma_rad);
}

Roll EstimateRoll(const ShiftFit& fit, const Eigen::VectorXd& x_rad, const Eigen::VectorXd& y_rad,
                  const AutocollimatorNoise& noise) {
  Roll roll;
  if (!fit.determined() || fit.dof() < kLeastDof) return roll;
  const Eigen::VectorXd x = fit.Residuals(x_rad), y = fit.Residuals(y_rad);
  const AutocollimatorNoise u = std::isfinite(noise.u_x_rad) ? noise : NoiseOfResiduals(x, y, fit.dof());
  const double of_noise = std::isfinite(u.u_y_rad) ? u.u_y_rad * u.u_y_rad * fit.dof() : 0.0;
  const double of_tilts = y.squaredNorm() - of_noise;
  roll.tilt_rms_rad = std::sqrt(std::max(of_tilts, 0.0) / static_cast<double>(y.size()));
  if (!(y.squaredNorm() > kLeastSignal * of_noise) || of_tilts < 1e-20 * y_rad.squaredNorm()) return roll;
  roll.attenuation = of_tilts / y.squaredNorm();
  const double slope = x.dot(y) / of_tilts;
  const double u_slope = std::hypot(u.u_x_rad, slope * u.u_y_rad) * y.norm() / of_tilts;
  roll.gamma_rad = std::atan(slope);
  roll.u_gamma_rad = u_slope / (1.0 + slope * slope);
  roll.status = RollStatus::kOk;
  return roll;
}

Roll EstimateRoll(const std::vector<TurntableStop>& stops, const AutocollimatorNoise& stated, int positions) {
  const StopGrid grid = FindGrid(stops, positions);
  const Readings readings = Collect(stops, grid);
  const AutocollimatorNoise noise = std::isfinite(stated.u_x_rad) ? stated : NoiseOfRepeats(stops, grid);
  return EstimateRoll(ShiftFit(grid), readings.x_rad, readings.y_rad, noise);
}

}  // namespace twinbench::separate::turntable
