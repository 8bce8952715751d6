#include "twin/benches/rotary_4dof/estimators/calibrate.h"

#include "tests/measure/bench.h"

namespace twinbench::measure {
namespace {

Detectors Imperfect(double noise_m) {
  Detectors d;
  d.gain << 1.004, 0.997, 0.992, 1.006;
  d.roll_rad << 0.004, -0.012;
  d.noise_m = noise_m;
  return d;
}

const Vector4 kMount(30 * units::arcsec, -40 * units::arcsec, 25 * units::arcsec, 20 * units::um);

Calibration Found(double noise_m, Stream* noise, const BenchGeometry& geometry = Bench()) {
  return Calibrate(CalibrationSweeps(Imperfect(noise_m), kMount, noise), geometry);
}

TEST(Calibrate, FindsGainsAndRollsOfANoiseFreeSweep) {
  const Detectors truth = Imperfect(0.0);
  const Calibration found = Found(0.0, nullptr);
  ASSERT_TRUE(found.measured);
  // The prior of 2 % and 20 mrad, weighed against the assumed 0.3 um, pulls by (3e-4 / 0.02)^2 = 2e-4 of a
  // deviation.
  EXPECT_LT((found.gain - truth.gain).cwiseAbs().maxCoeff(), 3e-6);
  EXPECT_LT((found.roll_rad - truth.roll_rad).cwiseAbs().maxCoeff(), 3e-6);
  EXPECT_LT(found.residual_rms_m.maxCoeff(), 1e-9);
}

TEST(Calibrate, TakesTheKnownGainOfTheAutocollimatorOutOfBothAngles) {
  BenchGeometry geometry = Bench();
  geometry.autocollimator_gain = 1.02;
  std::vector<Reading> readings = CalibrationSweeps(Imperfect(0.0), kMount, nullptr);
  for (Reading& r : readings) {
    r.autocollimator_yaw_rad *= 1.02;
    r.autocollimator_tilt_rad *= 1.02;
  }
  EXPECT_LT((Calibrate(readings, geometry).gain - Imperfect(0.0).gain).cwiseAbs().maxCoeff(), 3e-6);
}

TEST(Calibrate, StatesAnUncertaintyThatMatchesItsScatter) {
  constexpr int kRuns = 100;
  const Detectors truth = Imperfect(0.3e-6);
  Stream noise(5, "test.calibration");
  double sum = 0.0, sum_chi2 = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const Calibration found = Found(0.3e-6, &noise);
    Eigen::Matrix<double, 6, 1> error;
    error << found.gain - truth.gain, found.roll_rad - truth.roll_rad;
    sum += error.dot(found.cov.inverse() * error);
    sum_chi2 += found.chi2 / found.dof;
  }
  // Six degrees of freedom a run: the mean has standard deviation sqrt(12 / 100) = 0.35.
  EXPECT_NEAR(sum / kRuns, 6.0, 1.2);
  // 198 degrees of freedom a run: 0.01; the autocollimator's share in the weights (0.7 %) is not in these readings.
  EXPECT_NEAR(sum_chi2 / kRuns, 1.0, 0.04);
}

/// Gains from evenly noisy readings: the autocollimator has the share of a gain's variance that it has of a reading's; the prior, a sixth observation
/// of 2 %, that of its information.
TEST(Calibrate, TellsNoiseOfTheAutocollimatorAndThePriorApart) {
  constexpr double kNoise_m = 0.3e-6;
  BenchGeometry geometry = Bench();
  geometry.autocollimator_noise_rad = 1.0 * units::urad;
  Stream noise(6, "test.calibration");
  const Calibration found = Found(kNoise_m, &noise, geometry);
  const double cos_theta = std::sqrt(1.0 - std::pow(geometry.SinTheta(), 2)), l1_m = geometry.psd_distance_m[0];
  const auto share = [&](double lever_m) {
    const double of_angle = std::pow(lever_m * geometry.autocollimator_noise_rad, 2);
    return of_angle / (of_angle + kNoise_m * kNoise_m);
  };
  EXPECT_NEAR(found.of_autocollimator[0], share(l1_m * (1.0 + 1.0 / cos_theta)), 0.01);
  EXPECT_NEAR(found.of_autocollimator[1], share(l1_m * (1.0 + cos_theta)), 0.01);
  EXPECT_NEAR(found.of_prior[0], found.cov(0, 0) / (kPriorGain * kPriorGain), 0.05 * found.of_prior[0]) << "gains hardly know of each other";
}

TEST(Calibrate, StatesItsPriorWithoutCalibrationReadings) {
  const Calibration prior = Calibrate({}, Bench());
  EXPECT_FALSE(prior.measured);
  EXPECT_EQ(prior.gain, Eigen::Vector4d::Ones());
  EXPECT_DOUBLE_EQ(prior.cov(0, 0), kPriorGain * kPriorGain);
  EXPECT_EQ(prior.of_prior[1], 1.0);
  EXPECT_EQ(prior.notes.size(), 1u);
}

TEST(Calibrate, LeavesTheTiltGainsToThePriorWhenOnlyYawWasSwept) {
  auto sweeps = CalibrationSweeps(Imperfect(0.3e-6), kMount, nullptr);
  sweeps.resize(26);
  const Calibration found = Calibrate(sweeps, Bench());
  EXPECT_LT(std::sqrt(found.cov(0, 0)), 1e-3);
  EXPECT_GT(std::sqrt(found.cov(1, 1)), 0.5 * kPriorGain);
  EXPECT_GT(found.of_prior[1], 0.9);
}

Calibration Known() {
  Calibration calibration;
  calibration.gain = Imperfect(0.0).gain;
  calibration.roll_rad = Imperfect(0.0).roll_rad;
  return calibration;
}

TEST(SpotCalibrationJacobian, AgreesWithDifferences) {
  constexpr double kStep = 1e-6;
  const Calibration at = Known();
  const std::array<double, kChannels> mean_V = {0.5, -0.7, 0.2, 0.9};
  const Matrix46 jacobian = SpotCalibrationJacobian(SpotsFromVoltages(mean_V, Bench(), at), at);
  for (int p = 0; p < kCalibrationParameters; ++p) {
    Calibration more = at, less = at;
    (p < 4 ? more.gain[p] : more.roll_rad[p - 4]) += kStep;
    (p < 4 ? less.gain[p] : less.roll_rad[p - 4]) -= kStep;
    const Vector4 difference = SpotsFromVoltages(mean_V, Bench(), more) - SpotsFromVoltages(mean_V, Bench(), less);
    EXPECT_LT((jacobian.col(p) - difference / (2 * kStep)).norm(), 1e-12);  // 1e-4 m, step^2 = 1e-12 and rounding
  }
}

}  // namespace
}  // namespace twinbench::measure
