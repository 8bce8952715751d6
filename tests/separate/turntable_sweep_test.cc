#include "tests/support/noise.h"
#include "tests/support/over_seeds.h"
#include "twin/benches/turntable_autocollimator/estimators/collimator_sweep.h"
#include "twin/core/units.h"

// An autocollimator through known angles: every number by the closed form that the readings were made of.
namespace twinbench::separate::turntable {
namespace {

using units::arcsec;

struct SweepOf {
  std::function<double(double)> x_arcsec, y_arcsec = {};
  double half_arcsec = 100.0, noise_arcsec = 0.05, backward_arcsec = 0.0;
  int points = 81;
  std::uint64_t seed = 1;
  bool both_ways = false;
};

std::vector<Reading> Made(const SweepOf& of) {
  twinbench::test::Noise noise(of.noise_arcsec, of.seed);
  std::vector<Reading> readings;
  for (const int direction : {1, -1}) {
    if (direction < 0 && !of.both_ways) break;
    for (int k = 0; k < of.points; ++k) {
      const double angle_arcsec = direction * of.half_arcsec * (2.0 * k / (of.points - 1) - 1.0);
      Reading& r = readings.emplace_back();
      r.phase = Phase::kCalibration;
      r.direction = direction;
      r.pass = direction > 0 ? 0 : 1;
      r.target_rad = angle_arcsec * arcsec;
      r.autocollimator_yaw_rad =
          (of.x_arcsec(angle_arcsec) + noise() + (direction < 0 ? of.backward_arcsec : 0.0)) * arcsec;
      if (of.y_arcsec) r.autocollimator_tilt_rad = (of.y_arcsec(angle_arcsec) + noise()) * arcsec;
    }
  }
  return readings;
}

void ExpectWithin(const SweptValue& found, double truth, double unit, double of_u, const char* what) {
  EXPECT_NEAR(found.value / unit, truth, 4.0 * found.u / unit) << what;
  EXPECT_LT(found.u / unit, of_u) << what;
}

TEST(CollimatorSweep, FindsScaleAndRipple) {
  const double period_arcsec = 9.7;
  const auto sweep = AnalyseSweep(Made({.x_arcsec = [=](double a) {
    return 2.0 + 0.993 * a + 0.2 * std::cos(units::turn * a / period_arcsec + 1.0);
  }}));
  ASSERT_TRUE(sweep);
  EXPECT_FALSE(sweep->is_along_y);
  EXPECT_EQ(sweep->axis.Sense(), 1);
  ExpectWithin(sweep->axis.scale, 0.993, 1.0, 3e-4, "scale");
  ASSERT_EQ(sweep->axis.ripples.size(), 1U);
  ExpectWithin(sweep->axis.ripples[0].period_rad, period_arcsec, arcsec, 0.1, "period");
  ExpectWithin(sweep->axis.ripples[0].amplitude_rad, 0.2, arcsec, 0.02, "amplitude");
  EXPECT_NEAR(sweep->axis.u_reading_rad / arcsec, 0.05, 0.015);
  EXPECT_TRUE(std::isnan(sweep->axis.bend_rad.value)) << "it is straight";
  EXPECT_TRUE(std::isnan(sweep->axis.reversal_rad.value)) << "it went one way";
}

/// Whoever says that chance explains something in one of a thousand sweeps is wrong no more often.
TEST(CollimatorSweep, FindsNothingInNoise) {
  const int found = test::CountOverSeeds(400, [](std::uint64_t seed) {
    const auto sweep =
        AnalyseSweep(Made({.x_arcsec = [](double a) { return 1.01 * a; }, .points = 41, .seed = seed}));
    return !sweep->axis.ripples.empty() || std::isfinite(sweep->axis.bend_rad.value);
  });
  EXPECT_LE(found, 6) << "three bounds of a thousandth, four hundred times: 1.2, and rarely more than five";
}

/// The line of least squares of a cube c (a / h)^3 over a sweep of half h, close and even: it adds 3 c / 5 h to the
/// slope, and the ends lie 2 c / 5 off it.
TEST(CollimatorSweep, TellsTheLineFromTheMiddleWhereItBends) {
  const auto sweep =
      AnalyseSweep(Made({.x_arcsec = [](double a) { return a + 3.0 * std::pow(a / 100.0, 3); }, .points = 2001}));
  ExpectWithin(sweep->axis.scale, 1.0 + 3.0 * 0.6 / 100.0, 1.0, 1e-4, "line");
  ExpectWithin(sweep->axis.scale_in_middle, 1.0, 1.0, 2e-4, "middle");
  EXPECT_NEAR(sweep->axis.bend_rad.value / arcsec, 1.2, 0.03);
  EXPECT_TRUE(sweep->axis.ripples.empty());
}

TEST(CollimatorSweep, SaysAnotherSenseTheWayBackAndTheOtherAxis) {
  const auto sweep = AnalyseSweep(Made({.x_arcsec = [](double a) { return -a; },
                                        .y_arcsec = [](double a) { return 5.0 - 0.01 * a; },
                                        .backward_arcsec = 0.3,
                                        .both_ways = true}));
  EXPECT_EQ(sweep->axis.Sense(), -1);
  ExpectWithin(sweep->axis.scale, -1.0, 1.0, 2e-4, "scale");
  ExpectWithin(sweep->axis.reversal_rad, -0.3, arcsec, 0.02, "the way back");
  ASSERT_TRUE(sweep->crosstalk);
  ExpectWithin(*sweep->crosstalk, 0.01, 1.0, 2e-4, "y by x");
}

TEST(CollimatorSweep, TakesTheAxisThatFollows) {
  const auto tilted = AnalyseSweep(
      Made({.x_arcsec = [](double a) { return 0.002 * a; }, .y_arcsec = [](double a) { return 0.98 * a; }}));
  EXPECT_TRUE(tilted->is_along_y);
  ExpectWithin(tilted->axis.scale, 0.98, 1.0, 3e-4, "scale");
  const auto blind = AnalyseSweep(Made({.x_arcsec = [](double) { return 0.0; }}));
  EXPECT_EQ(blind->axis.Sense(), 0) << "it shows nothing but noise";
  EXPECT_FALSE(AnalyseSweep({}));
}

/// u is the scatter of what comes out.
TEST(CollimatorSweep, StatesWhatItScattersBy) {
  const auto pull2 = [](const SweptValue& v, double truth) { return std::pow((v.value - truth) / v.u, 2); };
  const Eigen::Array3d squares = test::MeanOverSeeds(200, [&](std::uint64_t seed) {
    const auto sweep = AnalyseSweep(Made(
        {.x_arcsec = [](double a) { return 1.02 * a + 0.15 * std::sin(units::turn * a / 23.0); }, .seed = seed}));
    EXPECT_EQ(sweep->axis.ripples.size(), 1U) << seed;
    const auto& ripple = sweep->axis.ripples.at(0);
    return Eigen::Array3d(pull2(sweep->axis.scale, 1.02), pull2(ripple.period_rad, 23.0 * arcsec),
                          pull2(ripple.amplitude_rad, 0.15 * arcsec));
  });
  for (const double mean : squares) EXPECT_NEAR(mean, 1.0, 0.35);
}

}  // namespace
}  // namespace twinbench::separate::turntable
