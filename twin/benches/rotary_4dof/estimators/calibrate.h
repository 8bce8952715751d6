#pragma once

#include <optional>
#include <string>
#include <vector>

#include "twin/benches/rotary_4dof/estimators/geometry.h"
#include "twin/benches/rotary_4dof/estimators/motion.h"
#include "twin/core/reading.h"

namespace twinbench::measure {

/// Believed of gains and rolls before any calibration; standard uncertainties.
inline constexpr double kPriorGain = 0.02;
inline constexpr double kPriorRoll_rad = 0.02;

using CalibrationVector = Eigen::Matrix<double, kCalibrationParameters, 1>;  // [gain, roll]

/// What a calibration sweep says of the PSDs: reading_V = sensitivity * gain * coordinate in axes turned by roll.
/// Roll is right-handed about the PSD's normal that points to the light.
struct Calibration {
  bool measured = false;  // false: no usable calibration readings, the values are the prior
  Eigen::Vector4d gain = Eigen::Vector4d::Ones();      // channels in scan order
  Eigen::Vector2d roll_rad = Eigen::Vector2d::Zero();  // PSD A, B
  Matrix6 cov = PriorCovariance();                     // of [gain, roll]
  /// Shares of its diagonal: what was believed before, and the stated noise of the autocollimator. The rest is that of the detectors.
  CalibrationVector of_prior = CalibrationVector::Ones(), of_autocollimator = CalibrationVector::Zero();
  Vector4 mount = Vector4::Constant(kNaN);             // constants of the calibration phase [ez, ex, ey, dy]
  int readings = 0;                                    // used
  int dof = 0;
  double chi2 = kNaN;                                // against the stated noise; NaN if that is not known
  Vector4 residual_rms_m = Vector4::Constant(kNaN);  // by channel, referred to the PSD's surface
  std::optional<double> published_l1_m;              // eq. 7 of the paper, from the yaw sweep
  std::vector<std::string> notes;

  static Matrix6 PriorCovariance();
};

/// Fits gains, rolls and mounting constants to the autocollimator sweeps on the exact grating model.
///
/// @param readings  Any; used are those of the calibration phase with status ok, four voltages and both
/// autocollimator
///                  angles. The sweeps turn the grating about the laser spot by Rz(yaw) Rx(tilt) in L, in front of
///                  constants that are the calibration's own.
/// @return the fit with covariance (Gauss-Newton; weights from noise of readings and autocollimator, else residual
///         scatter). The prior enters as six observations, so a sweep in one axis only is no failure. Without at
///         least three usable readings: the prior, and a note.
Calibration Calibrate(const std::vector<Reading>& readings, const BenchGeometry& geometry);

/// The four channels on the PSDs' surfaces [m]: voltages over sensitivities, nothing else.
Vector4 OnSurface(const std::array<double, kChannels>& mean_V, const BenchGeometry& geometry);

/// True spot coordinates [m] from voltages: divides by sensitivity and gain, turns the axes back.
Vector4 SpotsFromVoltages(const std::array<double, kChannels>& mean_V, const BenchGeometry& geometry,
                          const Calibration& calibration);

/// d spots / d [gain, roll] at given spots.
Matrix46 SpotCalibrationJacobian(const Vector4& spots_m, const Calibration& calibration);

/// What the channels show [m, sensitivity already divided out] when the spots are at `spots_m`.
Vector4 ShownSpots(const Vector4& spots_m, const Eigen::Vector4d& gain, const Eigen::Vector2d& roll_rad);

/// Random variances of the four channels' means [m^2] or nothing if std or n is missing.
std::optional<Vector4> SpotVariances(const Reading& reading, const BenchGeometry& geometry);

/// Of what the mean of a block that begins anywhere in the hum keeps of it. All channels have the same at once:
/// twice what one of them scatters by, so that taken one by one they give the sum of two spots what it has. Of
/// their difference it is too much.
Vector4 HumVariances_m2(int samples, const BenchGeometry& geometry);

}  // namespace twinbench::measure
