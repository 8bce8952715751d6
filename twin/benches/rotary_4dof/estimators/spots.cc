#include <cmath>

#include "twin/benches/rotary_4dof/estimators/calibrate.h"
#include "twin/core/units.h"

/// Between voltages and spots: sensitivity, gain, roll, noise.
namespace twinbench::measure {
namespace {

Eigen::Matrix2d Turn(double roll_rad) {
  return Eigen::Rotation2Dd(roll_rad).toRotationMatrix();
}

}  // namespace

Vector4 OnSurface(const std::array<double, kChannels>& V, const BenchGeometry& geometry) {
  const auto& s = geometry.sensitivity_V_m;
  return {V[0] / s[0], V[1] / s[0], V[2] / s[1], V[3] / s[1]};
}

Vector4 ShownSpots(const Vector4& spots_m, const Eigen::Vector4d& gain, const Eigen::Vector2d& roll_rad) {
  Vector4 shown_m;
  for (int p = 0; p < 2; ++p) {
    shown_m.segment<2>(2 * p) = Turn(-roll_rad[p]) * spots_m.segment<2>(2 * p);
  }
  return shown_m.cwiseProduct(gain);
}

Vector4 SpotsFromVoltages(const std::array<double, kChannels>& mean_V, const BenchGeometry& geometry,
                          const Calibration& calibration) {
  const Vector4 shown_m = OnSurface(mean_V, geometry).cwiseQuotient(calibration.gain);
  Vector4 spots_m;
  for (int p = 0; p < 2; ++p) {
    spots_m.segment<2>(2 * p) = Turn(calibration.roll_rad[p]) * shown_m.segment<2>(2 * p);
  }
  return spots_m;
}

Matrix46 SpotCalibrationJacobian(const Vector4& spots_m, const Calibration& calibration) {
  Matrix46 jacobian = Matrix46::Zero();
  for (int p = 0; p < 2; ++p) {
    const Eigen::Matrix2d turn = Turn(calibration.roll_rad[p]);
    const Eigen::Vector2d spot_m = spots_m.segment<2>(2 * p);
    const Eigen::Vector2d unturned_m = turn.transpose() * spot_m;
    const Eigen::Vector2d relative = unturned_m.cwiseQuotient(calibration.gain.segment<2>(2 * p));
    jacobian.block<2, 2>(2 * p, 2 * p) = -turn * relative.asDiagonal();
    jacobian.block<2, 1>(2 * p, 4 + p) << -spot_m.y(), spot_m.x();
  }
  return jacobian;
}

std::optional<Vector4> SpotVariances(const Reading& reading, const BenchGeometry& geometry) {
  Vector4 variance_m2;
  for (int c = 0; c < kChannels; ++c) {
    const double std_V = reading.std_V[static_cast<std::size_t>(c)];
    if (!std::isfinite(std_V) || reading.n_samples < 1) return std::nullopt;
    // Noise above one step dithers the converter, and std contains its share; below, averaging does not help.
    const double step_V = std_V < geometry.adc_step_V ? geometry.adc_step_V : 0.0;
    const double variance_V2 = std_V * std_V / reading.n_samples + step_V * step_V / 12.0;
    if (!(variance_V2 > 0.0)) return std::nullopt;
    variance_m2[c] = variance_V2 / std::pow(geometry.sensitivity_V_m[static_cast<std::size_t>(c / 2)], 2);
  }
  return variance_m2;
}

Vector4 HumVariances_m2(int samples, const BenchGeometry& geometry) {
  const double half_rad = units::kPi * geometry.hum_Hz * samples * geometry.scan_s;  // of its phase over the block
  const double left = half_rad > 0.0 ? std::sin(half_rad) / half_rad : 1.0;
  const auto& s = geometry.sensitivity_V_m;
  return Vector4(s[0], s[0], s[1], s[1]).cwiseAbs2().cwiseInverse() * std::pow(geometry.hum_V * left, 2);
}

}  // namespace twinbench::measure
