#include "optics/element_scene.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace twinbench::optics {
namespace {

using Eigen::Isometry3d, Eigen::Vector3d;

Isometry3d AtHeight(double z_m) {
  return Isometry3d(Eigen::Translation3d(0.0, 0.0, z_m));
}

PolarisedLight LightAt(const Ray& ray) {
  return {ray, LinearField(ray.direction, Vector3d(1.0, 0.3, 0.0), 1.0), 0};
}

TEST(ElementScene, AnIdealLensTakesEveryRayOfAPointToItsImage) {
  constexpr double kFocal_m = 0.05, kObject_m = 0.08;
  const double image_m = 1.0 / (1.0 / kFocal_m - 1.0 / kObject_m);
  ElementScene bench;
  const int lens = bench.Add(CircularPlane(AtHeight(0.0), 0.02), ThinLens{kFocal_m});
  const int screen = bench.Add(RectangularPlane(AtHeight(-image_m), 0.1, 0.1), Sink{});
  bench.Commit();
  const Vector3d point_m(0.004, -0.007, kObject_m);
  RayBatch rays;
  for (const double x_m : {-0.018, 0.0, 0.003, 0.015}) {
    for (const double y_m : {-0.008, 0.0, 0.007})
      rays.Add({point_m, (Vector3d(x_m, y_m, 0.0) - point_m).normalized()});
  }
  HitBatch hits;
  bench.FollowWay({{lens}, {screen}}, rays, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_EQ(hits.surface[i], screen);
    EXPECT_NEAR(hits.x_m[i], -image_m / kObject_m * point_m.x(), 1e-16);
    EXPECT_NEAR(hits.y_m[i], -image_m / kObject_m * point_m.y(), 1e-16);
  }
}

TEST(ElementScene, ALensOfGlassHasTheFocusOfItsMakersFormula) {
  // Plano-convex, convex side towards the light; a ray close to the axis.
  constexpr double kIndex = 1.5168, kRadius_m = 0.0258, kThickness_m = 0.004;
  const double focal_m = kRadius_m / (kIndex - 1.0), back_m = focal_m - kThickness_m / kIndex;
  ElementScene bench;
  const int front = bench.Add(Sphere(AtHeight(0.0), -kRadius_m, 0.01), Interface{1.0, kIndex});
  const int back = bench.Add(CircularPlane(AtHeight(-kThickness_m), 0.01), Interface{kIndex, 1.0});
  const int focus = bench.Add(RectangularPlane(AtHeight(-kThickness_m - back_m), 0.01, 0.01), Sink{});
  bench.Commit();
  const auto at_focus = [&](double x_m) {
    RayBatch ray;
    ray.Add({{x_m, 0.0, 0.05}, -Vector3d::UnitZ()});
    HitBatch hit;
    bench.FollowWay({{front}, {back}, {focus}}, ray, hit);
    EXPECT_EQ(hit.surface[0], focus);
    return hit.x_m[0];
  };
  EXPECT_NEAR(at_focus(1e-5), 0.0, 1e-12);  // what is left grows as the cube of the height
  // Spherical aberration bends outer rays too much: the cube between two heights.
  EXPECT_LT(at_focus(2e-3), 0.0);
  EXPECT_NEAR(at_focus(2e-3) / at_focus(1e-3), 8.0, 0.1);
}

TEST(ElementScene, AReducerNarrowsABeamAndKeepsItParallel) {
  ElementScene bench;
  const int outer = bench.Add(CircularPlane(AtHeight(0.06), 0.01), ThinLens{0.05});
  const int inner = bench.Add(CircularPlane(AtHeight(0.0), 0.01), ThinLens{0.01});
  bench.Commit();
  RayBatch rays;
  const std::array places_m = {-0.003, 0.001, 0.002};
  for (const double x_m : places_m) rays.Add({{x_m, 0.0, 0.1}, -Vector3d::UnitZ()});
  HitBatch hits;
  bench.FollowWay({{outer}, {inner}}, rays, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_NEAR(hits.x_m[i], places_m[i] / -5.0, 1e-16);
    EXPECT_NEAR(rays.At(i).direction.x(), 0.0, 1e-15);
  }
}

TEST(ElementScene, SplitsTheWholePowerAmongItsWays) {
  ElementScene bench;
  const WavePlate quarter{Vector3d(1.0, 1.0, 0.0).normalized(), 1.3};
  bench.Add(CircularPlane(AtHeight(0.1), 0.01), PolarisingSplitter{.p_reflected = 0.1, .s_transmitted = 0.2});
  bench.Add(CircularPlane(AtHeight(0.0), 0.01), CoatedPlate{quarter, 0.05, 0.0});
  const int floor = bench.Add(CircularPlane(AtHeight(-0.1), 0.01), Sink{});
  const int ceiling = bench.Add(CircularPlane(AtHeight(0.3), 0.01), Sink{});
  bench.Commit();
  Followed followed;
  bench.Follow(LightAt({{0.001, 0.0, 0.2}, -Vector3d::UnitZ()}), 1e-14, followed);
  EXPECT_TRUE(followed.leaving.empty());
  double to_floor = 0.0, to_ceiling = 0.0;
  for (const Arrival& a : followed.arrivals) (a.element == floor ? to_floor : to_ceiling) += a.power;
  EXPECT_NEAR(to_floor + to_ceiling, 1.0, 1e-11);
  EXPECT_GT(to_floor, 0.1);
  EXPECT_GT(to_ceiling, 0.1);
  EXPECT_NE(floor, ceiling);
}

TEST(ElementScene, LeavesOutRaysThatMeetSomethingElseFirstAndCountsThemAll) {
  ElementScene bench;
  bench.Add(CircularPlane(AtHeight(0.05), 0.001), Sink{});  // an obstacle on the axis
  const int screen = bench.Add(CircularPlane(AtHeight(0.0), 0.01), Sink{});
  bench.Commit();
  RayBatch rays;
  for (int i = 0; i < 37; ++i) rays.Add({{i % 2 * 0.002, 0.0, 0.1}, -Vector3d::UnitZ()});
  HitBatch hits;
  bench.FollowWay({{screen}}, rays, hits);
  for (int i = 0; i < 37; ++i) EXPECT_EQ(hits.surface[static_cast<std::size_t>(i)], i % 2 ? screen : kNothing);
  EXPECT_EQ(bench.scene().rays_traced(), 37u);
}

TEST(ElementScene, RefusesElementsThatCannotBe) {
  ElementScene bench;
  const Surface plane = CircularPlane(AtHeight(0.0), 0.01);
  EXPECT_THROW(bench.Add(plane, ThinLens{0.0}), std::invalid_argument);
  EXPECT_THROW(bench.Add(plane, PolarisingSplitter{.p_reflected = 1.1}), std::invalid_argument);
  EXPECT_THROW(bench.Add(plane, Interface{0.0, 1.0}), std::invalid_argument);
  EXPECT_THROW(bench.Add(plane, CoatedPlate{{}, -0.1, 0.0}), std::invalid_argument);
}

}  // namespace
}  // namespace twinbench::optics
