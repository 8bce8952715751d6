#include <gtest/gtest.h>

#include <cmath>

#include "tests/measure/bench.h"
#include "twin/benches/rotary_4dof/estimators/published_motion.h"

namespace twinbench::measure {
namespace {

const double kCos = std::cos(std::asin(0.39));

/// What the published equations read when the exact model moves by one small step in one DOF.
Vector4 Response(Dof dof) {
  constexpr double kStep = 1e-7;  // rad or m; second order is 1e-7 of it
  const Vector4 spots_m = PredictSpots(Vector4(kStep * Vector4::Unit(static_cast<int>(dof))), Bench());
  return PublishedMotion(spots_m, 0.120, Bench()) / kStep;
}

TEST(PublishedMotion, ReadsWrongByTheFactorsOfTheMirrorPicture) {
  const double tolerance = 1e-5;  // second order of the step, times 1/sin(theta)
  EXPECT_NEAR(Response(Dof::kEz)[0], (1 + 1 / kCos) / (2 * kCos), tolerance);
  EXPECT_NEAR(Response(Dof::kEz)[0], 1.1327, 1e-4);  // docs/theory.md 1
  EXPECT_NEAR(Response(Dof::kEx)[1], (1 + kCos) / 2, tolerance);
  EXPECT_NEAR(Response(Dof::kEy)[2], 1.0, tolerance);
  EXPECT_NEAR(Response(Dof::kDy)[3], kCos, tolerance);
}

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
