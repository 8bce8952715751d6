#pragma once

#include "tests/support/rotary_scenario.h"
#include "twin/benches/rotary_4dof/estimators/grating_model.h"
#include "twin/benches/rotary_4dof/estimators/measure.h"
#include "twin/core/stream.h"

/// What the tests of this room share: the reference bench, and readings made straight from motions.
namespace twinbench::measure {

inline BenchGeometry Bench() { return NominalGeometry(test::RotaryScenario()); }

/// Imperfections of the detectors that a calibration should find.
struct Detectors {
  Eigen::Vector4d gain = Eigen::Vector4d::Ones();
  Eigen::Vector2d roll_rad = Eigen::Vector2d::Zero();
  double noise_m = 0.0;  // standard deviation of the mean of a block
};

inline Reading ReadingOf(const Vector4& spots_m, const Detectors& detectors, Stream* noise) {
  constexpr int kSamples = 100;
  Reading r;
  const Vector4 shown_m = ShownSpots(spots_m, detectors.gain, detectors.roll_rad);
  for (int c = 0; c < kChannels; ++c) {
    const double extra_m = noise == nullptr ? 0.0 : detectors.noise_m * noise->Normal();
    r.mean_V[static_cast<std::size_t>(c)] = 2000.0 * (shown_m[c] + extra_m);
    r.std_V[static_cast<std::size_t>(c)] = 2000.0 * detectors.noise_m * 10.0;
  }
  r.n_samples = kSamples;
  return r;
}

/// Two sweeps of +-300 arcsec, in yaw and in tilt, both directions, in front of a mounting constant.
inline std::vector<Reading> CalibrationSweeps(const Detectors& detectors, const Vector4& mount, Stream* noise) {
  std::vector<Reading> readings;
  for (int k = 0; k < 52; ++k) {
    const double angle_rad = 50.0 * units::arcsec * (k % 26 < 13 ? k % 26 - 6 : 18 - k % 26);
    const double yaw_rad = k < 26 ? angle_rad : 0.0, tilt_rad = k < 26 ? 0.0 : angle_rad;
    const Matrix3 turn =
        (Eigen::AngleAxisd(yaw_rad, Vector3::UnitZ()) * Eigen::AngleAxisd(tilt_rad, Vector3::UnitX()))
            .toRotationMatrix();
    Reading r = ReadingOf(PredictSpots(turn * MotionRotation(mount), mount[3], Bench()), detectors, noise);
    r.phase = Phase::kCalibration;
    r.autocollimator_yaw_rad = yaw_rad;
    r.autocollimator_tilt_rad = tilt_rad;
    readings.push_back(r);
  }
  return readings;
}

}  // namespace twinbench::measure
