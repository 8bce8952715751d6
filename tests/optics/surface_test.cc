#include "optics/surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace twinbench::optics {
namespace {

using Eigen::Isometry3d, Eigen::Vector3d;

TEST(Meet, LandsOnThePlaneInItsOwnCoordinatesAndDecidesTheApertureInDouble) {
  const Isometry3d X_WS(Eigen::Translation3d(0.1, 0.2, 0.3));
  const SurfaceHit hit = Meet(RectangularPlane(X_WS, 0.02, 0.04), {{0.105, 0.185, 0.5}, {0, 0, -1}}, 0.0);
  EXPECT_NEAR(hit.t_m, 0.2, 1e-16);
  EXPECT_NEAR(hit.x_m, 0.005, 1e-16);
  EXPECT_NEAR(hit.y_m, -0.015, 1e-16);
  const Surface plane = RectangularPlane(Isometry3d::Identity(), 0.02, 0.02);
  const auto meets = [&](const Ray& ray) { return std::isfinite(Meet(plane, ray, 0.0).t_m); };
  for (const double x : {0.01, 0.01 - 1e-15}) EXPECT_TRUE(meets({{x, 0, 1}, {0, 0, -1}}));
  EXPECT_FALSE(meets({{0.01 + 1e-15, 0, 1}, {0, 0, -1}}));
  EXPECT_FALSE(meets({{0, 0, 1}, {0, 0, 1}})) << "it is behind";
  for (const double z : {0.0, 1.0}) EXPECT_FALSE(meets({{0, 0, z}, {1, 0, 0}})) << "parallel";
}

TEST(Meet, TakesTheVertexSideOfASphere) {
  const Surface mirror = Sphere(Isometry3d::Identity(), 0.5, 0.1);  // centre of curvature at z = +0.5
  const SurfaceHit hit = Meet(mirror, {{0.05, 0, 2.0}, {0, 0, -1}}, 0.0);
  // Coming from above it passes the far half of the sphere and meets z = R - sqrt(R^2 - x^2).
  EXPECT_NEAR(hit.t_m, 2.0 - (0.5 - std::sqrt(0.25 - 0.0025)), 1e-15);
}

TEST(Paraboloid, GathersCollimatedLightInItsFocus) {
  const double f = 0.1;
  const Surface mirror = Paraboloid(Isometry3d::Identity(), f, 0.08);
  for (const double x : {0.0, 0.01, 0.05, -0.07}) {
    const Ray ray{{x, 0.01, 0.5}, {0, 0, -1}};
    const SurfaceHit hit = Meet(mirror, ray, 0.0);
    ASSERT_TRUE(std::isfinite(hit.t_m));
    const Vector3d normal = Normal(mirror, hit.x_m, hit.y_m);
    const Vector3d out = ray.direction - 2.0 * ray.direction.dot(normal) * normal;
    const Vector3d to_focus = Vector3d(0, 0, f) - Point(mirror, hit.x_m, hit.y_m);
    // A = 0 here, the case in which the schoolbook root formula divides by zero.
    EXPECT_LT(out.cross(to_focus).norm(), 1e-16);
  }
}

TEST(Point, LiesOnTheConicThatMeetFinds) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 500; ++i) {
    Isometry3d X_WS(
        Eigen::AngleAxisd(3 * uniform(random), Vector3d(uniform(random), uniform(random), 1).normalized()));
    X_WS.translation() = 0.3 * Vector3d(uniform(random), uniform(random), uniform(random));
    const Surface s = i % 2 ? Sphere(X_WS, -0.3, 0.05) : Paraboloid(X_WS, 0.1, 0.05);
    const double x = 0.03 * uniform(random), y = 0.03 * uniform(random);
    const Vector3d target = Point(s, x, y), from = target + 0.2 * Normal(s, x, y);
    const SurfaceHit hit = Meet(s, {from, (target - from).normalized()}, 0.0);
    EXPECT_NEAR(hit.x_m, x, 1e-15);  // a few roundings of 0.5 m
    EXPECT_NEAR(hit.y_m, y, 1e-15);
    EXPECT_NEAR(hit.t_m, 0.2, 1e-15);
  }
}

TEST(Surface, RefusesWhatIsNotASurface) {
  EXPECT_THROW(Validate(Surface{}), std::invalid_argument);
  EXPECT_THROW(Validate(Sphere(Isometry3d::Identity(), 0.1, 0.11)), std::invalid_argument);
  Isometry3d scaled = Isometry3d::Identity();
  scaled.linear() *= 1.001;
  EXPECT_THROW(Validate(CircularPlane(scaled, 0.1)), std::invalid_argument);
}

}  // namespace
}  // namespace twinbench::optics
