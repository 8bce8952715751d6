#include "tests/measure/bench.h"
#include "twin/benches/rotary_4dof/estimators/published_motion.h"

namespace twinbench::measure {
namespace {

constexpr double kL1_m = 0.120;
const double kTheta = std::asin(0.39);

TEST(PredictSpots, AreAtTheCentresForANominalGrating) {
  EXPECT_LT(PredictSpots(Vector4::Zero(), Bench()).norm(), 1e-16);  // rounding of 0.12 m
}

TEST(SpotJacobian, HasTheClosedFormSensitivitiesOfAPerpendicularPsd) {
  const Matrix4 d = SpotJacobian(Vector4::Zero(), Bench());
  const double c = std::cos(kTheta), s = std::sin(kTheta);
  Matrix4 expected;                            // rows a_u, a_v, b_u, b_v; columns ez, ex, ey, dy
  expected << -kL1_m * (1 + 1 / c), 0, 0, -s,  //
      0, kL1_m * (1 + c), -kL1_m * s, 0,       //
      -kL1_m * (1 + 1 / c), 0, 0, s,           //
      0, kL1_m * (1 + c), kL1_m * s, 0;
  // Central differences of step 1e-5: third derivatives give 1e-10 of the length.
  EXPECT_LT((d - expected).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_NEAR(1 + 1 / c, 2.0860, 5e-5);  // the published digits
}

TEST(SolveMotion, FindsTheMotionThatMadeTheSpots) {
  const Vector4 motion(900 * units::arcsec, -700 * units::arcsec, 1100 * units::arcsec, -230 * units::um);
  const MotionFit fit = SolveMotion(PredictSpots(motion, Bench()), Bench());
  ASSERT_TRUE(fit.converged);
  EXPECT_LT((fit.motion - motion).cwiseAbs().maxCoeff(), 1e-13);  // the stopping rule
}

TEST(SolveMotion, SaysSoWhenNoMotionGivesTheSpots) {
  EXPECT_FALSE(SolveMotion(Vector4::Constant(1e3), Bench()).converged);
}

TEST(PredictSpots, IsNaNWhenTheOrderIsEvanescent) {
  // Turned by 45 degrees, sin(45) + 0.39 > 1: order +1 or -1 cannot leave the grating.
  EXPECT_FALSE(PredictSpots(Vector4(units::kPi / 4.0, 0, 0, 0), Bench()).allFinite());
}

const Vector4 kMotion(20 * units::arcsec, -15 * units::arcsec, 30 * units::arcsec, 4 * units::um);

Reading OneReading(double noise_m = 0.3e-6) {
  Detectors d{.noise_m = noise_m};
  return ReadingOf(PredictSpots(kMotion, Bench()), d, nullptr);
}

Motion Measured(const Reading& reading, const Calibration& calibration = {}) {
  return Measure({reading}, Bench(), calibration, Estimator::kRigorous).at(0);
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
  Detectors d{.noise_m = 0.3e-6};
  Stream noise(1, "test.measure");
  double sum = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const Motion m = Measured(ReadingOf(PredictSpots(kMotion, Bench()), d, &noise));
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

/// A common part of both spots' x is a yaw: of l (1 + 1/cos) a radian.
TEST(Measure, CountsWhatABlockLeavesOfTheHumForBothSpotsTogether) {
  BenchGeometry humming = Bench();
  humming.hum_V = 1e-3, humming.hum_Hz = 50.0, humming.scan_s = 16e-6;
  Reading reading = OneReading();
  reading.n_samples = 1000;
  const double half_rad = units::kPi * 50.0 * 16e-3;
  const double hum_m = std::sqrt(0.5) * 1e-3 / 2000.0 * std::sin(half_rad) / half_rad;
  const Matrix4 added = Measure({reading}, humming, {}, Estimator::kRigorous)[0].cov - Measured(reading).cov;
  EXPECT_NEAR(std::sqrt(added(0, 0)), hum_m / (kL1_m * (1 + 1 / std::cos(kTheta))), 1e-3 * hum_m);
}

TEST(Measure, KeepsTheCalibrationsUncertaintyApartFromTheNoise) {
  const Motion m = Measured(OneReading());
  // Prior of 2 % on both x gains: u(ez) = ez 2 % / sqrt 2 and the same again for each part; rolls add the tilts.
  const double u_gains_rad = 0.02 / std::sqrt(2.0) * 20 * units::arcsec;
  EXPECT_GT(std::sqrt(m.cov_systematic(0, 0)), 0.9 * u_gains_rad);
  EXPECT_LT(std::sqrt(m.cov_systematic(0, 0)), 2.0 * u_gains_rad);
  Calibration sure;
  sure.cov.setZero();
  const Motion exact = Measured(OneReading(), sure);
  EXPECT_EQ(exact.cov_systematic, Matrix4::Zero());
  EXPECT_EQ(exact.cov, m.cov);
}

const double kCos = std::cos(std::asin(0.39));

TEST(PublishedMotion, IsTheInverseOfEquationsOneToFive) {
  const double l1 = 0.120, h0 = 0.130, theta = std::asin(0.39);
  const double ez = 3e-4, ex = -2e-4, ey = 4e-4, dy = 5e-5;  // in the paper's frame
  const double ax = l1 * (std::sin(theta + 2 * ez) - std::sin(theta)) + dy * std::tan(theta);
  const double bx = l1 * (std::sin(theta) - std::sin(theta - 2 * ez)) - dy * std::tan(theta);
  const double common = l1 * std::tan(2 * ex) + h0 * std::sin(ey) * std::tan(ey);  // without h0 sin(ex), as eq. 12
  const double ay = common + l1 * std::sin(theta) * std::tan(ey), by = common - l1 * std::sin(theta) * std::tan(ey);
  const Vector4 found = PublishedMotion(Vector4(ax, ay, bx, by), l1, Bench());
  EXPECT_LT((found - Vector4(-ez, ex, -ey, -dy)).cwiseAbs().maxCoeff(), 1e-15);  // rounding
}

TEST(PublishedDistance, TakesTheMirrorPictureIntoItsDistance) {
  const auto sweeps = CalibrationSweeps({}, Vector4(2e-5, -3e-5, 1e-5, 0.0), nullptr);
  // 1.1327 l1 (docs/theory.md 1); the sweep's third order, (300 arcsec)^2 = 2e-6, stays below the tolerance.
  EXPECT_NEAR(PublishedDistance(sweeps, Bench()).value(), 0.120 * (1 + 1 / kCos) / (2 * kCos), 1e-6);
  EXPECT_FALSE(PublishedDistance({}, Bench()).has_value());
}

TEST(Measure, RemovesTheMeanShiftOfEverySetUpInThePublishedEstimator) {
  std::vector<Reading> readings;
  for (int k = 0; k < 8; ++k) {
    const Vector4 motion(0, 0, 0, 1e-6 * k + (k < 4 ? 0 : 3e-5));
    readings.push_back(ReadingOf(PredictSpots(motion, Bench()), {}, nullptr));
    readings.back().setup = k / 4;
  }
  const auto motions = Measure(readings, Bench(), {}, Estimator::kPublished);
  for (int first : {0, 4}) {
    double sum_m = 0.0;
    for (int k = first; k < first + 4; ++k) sum_m += motions[static_cast<std::size_t>(k)].dy_m;
    EXPECT_NEAR(sum_m, 0.0, 1e-18);  // rounding
  }
  EXPECT_NEAR(motions[3].dy_m - motions[0].dy_m, 3e-6 * kCos, 1e-10);  // second order
}

}  // namespace
}  // namespace twinbench::measure
