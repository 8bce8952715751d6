#include "twin/benches/rotary_4dof/estimators/grating_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/measure/bench.h"

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

}  // namespace
}  // namespace twinbench::measure
