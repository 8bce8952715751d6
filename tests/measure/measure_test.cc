#include "twin/benches/rotary_4dof/estimators/measure.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "tests/measure/bench.h"

namespace twinbench::measure {
namespace {

const Vector4 kMotion(20 * units::arcsec, -15 * units::arcsec, 30 * units::arcsec, 4 * units::um);

Reading OneReading(double noise_m = 0.3e-6) {
  Detectors d;
  d.noise_m = noise_m;
  return ReadingOf(PredictSpots(kMotion, Bench()), d, nullptr);
}

TEST(Measure, ReturnsTheMotionThatMadeTheReading) {
  const Motion m = Measure({OneReading()}, Bench(), {}, Estimator::kRigorous).at(0);
  EXPECT_EQ(m.status, ReadingStatus::kOk);
  EXPECT_LT((m.Values() - kMotion).cwiseAbs().maxCoeff(), 1e-13);  // the stopping rule of the solution
}

TEST(Measure, NeverGivesANumberForAReadingThatHasNone) {
  std::vector<Reading> readings(3, OneReading());
  readings[0].status = ReadingStatus::kSaturated;
  readings[1].mean_V[2] = kNaN;
  readings[2].mean_V = {1e9, 1e9, 1e9, 1e9};
  for (const Estimator estimator : {Estimator::kPublished, Estimator::kRigorous}) {
    const auto motions = Measure(readings, Bench(), {}, estimator);
    EXPECT_EQ(motions[0].status, ReadingStatus::kSaturated);
    for (const Motion& m : motions) {
      EXPECT_NE(m.status, ReadingStatus::kOk);
      EXPECT_FALSE(m.reason.empty());
      EXPECT_TRUE(m.Values().array().isNaN().all() && m.cov.array().isNaN().all());
    }
  }
}

TEST(Measure, StatesACovarianceThatMatchesTheScatter) {
  constexpr int kRuns = 500;
  Detectors d;
  d.noise_m = 0.3e-6;
  Stream noise(1, "test.measure");
  double sum = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const Reading r = ReadingOf(PredictSpots(kMotion, Bench()), d, &noise);
    const Motion m = Measure({r}, Bench(), {}, Estimator::kRigorous).at(0);
    const Vector4 error = m.Values() - kMotion;
    sum += error.dot(m.cov.inverse() * error);
  }
  EXPECT_NEAR(sum / kRuns, 4.0, 0.5);  // 4 degrees of freedom: sqrt(8 / 500) = 0.13
}

TEST(Measure, MarksTheCovarianceUnknownWithoutDeviationsOrCounts) {
  std::vector<Reading> readings(3, OneReading());
  readings[0].std_V[1] = kNaN;
  readings[1].n_samples = 0;
  readings[2].std_V = {0, 0, 0, 0};
  BenchGeometry no_steps = Bench();
  no_steps.adc_step_V = 0.0;
  for (const Motion& m : Measure(readings, no_steps, {}, Estimator::kRigorous)) EXPECT_FALSE(m.covariance_known);
}

TEST(SpotVariances, CountTheStepOfTheConverterOnlyWhenNoiseDoesNotDitherIt) {
  Reading quiet = OneReading(), noisy = OneReading();
  quiet.std_V.fill(0.0);
  const double step_m = 20.0 / 65536.0 / 2000.0;
  EXPECT_NEAR(SpotVariances(quiet, Bench()).value()[0], step_m * step_m / 12.0, 1e-25);  // rounding
  EXPECT_NEAR(SpotVariances(noisy, Bench()).value()[0], 0.09e-12, 1e-24);
}

TEST(Measure, KeepsTheCalibrationsUncertaintyApartFromTheNoise) {
  const Motion m = Measure({OneReading()}, Bench(), {}, Estimator::kRigorous).at(0);
  // Prior of 2 % on both x gains: u(ez) = ez 2 % / sqrt 2 and the same again for each part; rolls add the tilts.
  const double u_gains_rad = 0.02 / std::sqrt(2.0) * 20 * units::arcsec;
  EXPECT_GT(std::sqrt(m.cov_systematic(0, 0)), 0.9 * u_gains_rad);
  EXPECT_LT(std::sqrt(m.cov_systematic(0, 0)), 2.0 * u_gains_rad);
  Calibration sure;
  sure.cov.setZero();
  const Motion exact = Measure({OneReading()}, Bench(), sure, Estimator::kRigorous).at(0);
  EXPECT_EQ(exact.cov_systematic, Matrix4::Zero());
  EXPECT_EQ(exact.cov, m.cov);
}

}  // namespace
}  // namespace twinbench::measure
