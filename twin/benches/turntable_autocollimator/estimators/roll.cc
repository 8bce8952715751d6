#include "twin/benches/turntable_autocollimator/estimators/roll.h"

#include <cmath>

#include "twin/core/distributions.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"

namespace twinbench::separate::turntable {
namespace {

constexpr double kLeastSignal = 4.0;    // mean square of y over what noise alone leaves
constexpr double kNoChance = 0.001;     // probability that noise alone leaves so much
constexpr double kLeastOfTilt = 1e-9;   // of a tilt, that must be left of it; rounding leaves 1e-15

/// Equal noise of x and y that scatters the residuals about a line: orthogonal regression.
AutocollimatorNoise NoiseOfResiduals(const Eigen::VectorXd& x_rad, const Eigen::VectorXd& y_rad, double dof) {
  if (dof < 1.0 + kLeastDof) return {};
  Eigen::Matrix2d squares;
  squares << x_rad.squaredNorm(), x_rad.dot(y_rad), x_rad.dot(y_rad), y_rad.squaredNorm();
  const double least = EigenvaluesOfSymmetric(squares)[0];
  const double u_rad = std::sqrt(std::max(least, 0.0) / (dof - 1.0));
  return {u_rad, u_rad, static_cast<int>(std::lround(dof - 1.0))};
}

/// Whether a tilt of one of the set-ups would be left over by position, tooth and set-up.
bool ShowsTilts(const ShiftFit& fit) {
  const StopGrid& grid = fit.grid();
  for (int setup = 0; setup < std::ssize(grid.setups); ++setup) {
    for (const double azimuth_rad : {0.0, 0.25 * units::turn}) {
      Eigen::VectorXd tilt = Eigen::VectorXd::Zero(std::ssize(grid.stops));
      for (std::size_t k = 0; k < grid.stops.size(); ++k) {
        const GridStop& stop = grid.stops[k];
        if (stop.setup == setup) tilt[static_cast<Eigen::Index>(k)] = std::cos(grid.Position_rad(stop.position) - azimuth_rad);
      }
      if (fit.Residuals(tilt).norm() > kLeastOfTilt * tilt.norm()) return true;
    }
  }
  return false;
}

/// Whether y varies so that noise alone would hardly do it.
bool IsBeyondNoise(double mean_square, double dof, int dof_of_noise) {
  const double chance = dof_of_noise > 0 ? VarianceRatioExceedance(mean_square, dof, dof_of_noise)
                                         : ChiSquaredExceedance(mean_square * dof, dof);
  return mean_square > kLeastSignal && chance < kNoChance;
}

}  // namespace

double Roll::Correct(double x_rad, double y_rad) const {
  if (!std::isfinite(gamma_rad)) return x_rad;
  return x_rad * std::cos(gamma_rad) - y_rad * std::sin(gamma_rad);
}

Roll EstimateRoll(const ShiftFit& fit, const Eigen::VectorXd& x_rad, const Eigen::VectorXd& y_rad,
                  const AutocollimatorNoise& noise) {
  Roll roll;
  if (!fit.determined() || fit.dof() < kLeastDof || !ShowsTilts(fit)) return roll;
  const Eigen::VectorXd x = fit.Residuals(x_rad), y = fit.Residuals(y_rad);
  const AutocollimatorNoise u = std::isfinite(noise.u_x_rad) ? noise : NoiseOfResiduals(x, y, fit.dof());
  roll.status = RollStatus::kNoiseNotKnown;
  if (!std::isfinite(u.u_y_rad)) return roll;
  const double of_noise = u.u_y_rad * u.u_y_rad * fit.dof();
  const double of_tilts = y.squaredNorm() - of_noise;
  roll.tilt_rms_rad = std::sqrt(std::max(of_tilts, 0.0) / static_cast<double>(y.size()));
  roll.status = RollStatus::kTiltsAlike;
  if (!IsBeyondNoise(y.squaredNorm() / of_noise, fit.dof(), u.dof) || of_tilts < 1e-20 * y_rad.squaredNorm()) return roll;
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
