#include "twin/benches/turntable_autocollimator/estimators/polygon_series.h"

#include <algorithm>
#include <cmath>

#include "twin/core/units.h"

namespace twinbench::separate::turntable {

std::vector<double> DistinctAngles(const std::vector<FaceReading>& readings) {
  constexpr double kSame_rad = 1e-9;
  std::vector<double> angles_rad;
  for (const FaceReading& r : readings) {
    const double rest_rad = r.angle_rad - units::turn * std::floor(r.angle_rad / units::turn);
    angles_rad.push_back(rest_rad > units::turn - kSame_rad ? 0.0 : rest_rad);
  }
  std::ranges::sort(angles_rad);
  const auto is_same = [](double a, double b) { return b - a < kSame_rad; };
  angles_rad.erase(std::unique(angles_rad.begin(), angles_rad.end(), is_same), angles_rad.end());
  return angles_rad;
}

AngleSeries CurveAt(const HarmonicModel& curve, const std::vector<double>& angles_rad) {
  AngleSeries series;
  series.position_rad = angles_rad;
  Eigen::MatrixXd basis(std::ssize(angles_rad), 2 * curve.highest_order + 1);
  for (Eigen::Index i = 0; i < basis.rows(); ++i)
    basis.row(i) = HarmonicBasis(angles_rad[static_cast<std::size_t>(i)], curve.highest_order);
  const Eigen::RowVectorXd mean = basis.colwise().mean();
  basis.rowwise() -= mean;
  series.value_rad = basis * curve.coefficients_rad;
  Eigen::MatrixXd cov_rad2 = basis * curve.cov_rad2 * basis.transpose();
  cov_rad2.diagonal().array() += curve.u_unmodelled_rad * curve.u_unmodelled_rad;
  series.cov_rad2 = CurveCovariance::Dense(std::move(cov_rad2));
  return series;
}

FaceSeries ByOwnAngle(const std::vector<int>& names, const Eigen::VectorXd& value_rad,
                      const Eigen::MatrixXd& cov_rad2, int faces) {
  std::vector<std::pair<int, int>> by_step;
  for (std::size_t k = 0; k < names.size(); ++k)
    by_step.emplace_back((faces - names[k]) % faces, static_cast<int>(k));
  std::ranges::sort(by_step);
  FaceSeries series;
  std::vector<int> order;
  for (const auto& [step, k] : by_step) {
    series.errors.position_rad.push_back(step * units::turn / faces);
    series.face.push_back(names[static_cast<std::size_t>(k)]);
    order.push_back(k);
  }
  series.errors.value_rad = value_rad(order);
  series.errors.cov_rad2 = CurveCovariance::Dense(cov_rad2(order, order));
  return series;
}

}  // namespace twinbench::separate::turntable
