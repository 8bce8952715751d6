#include <gtest/gtest.h>

#include "optics/element_scene.h"
#include "tests/optics/example_bench.h"
#include "tests/support/oracle_poses.h"

namespace twinbench::optics {
namespace {

using Eigen::AngleAxisd, Eigen::Isometry3d, Eigen::Translation3d, Eigen::Vector3d;

Isometry3d Rz(double angle) { return Isometry3d(AngleAxisd(angle, Vector3d::UnitZ())); }

Isometry3d Pose(const test::OracleError& e) {
  return Translation3d(e[3], e[4], e[5]) * AngleAxisd(e[2], Vector3d::UnitZ()) *
         AngleAxisd(e[1], Vector3d::UnitY()) * AngleAxisd(e[0], Vector3d::UnitX());
}

Isometry3d GratingPose(const test::OraclePose& p) {
  return Translation3d(0, -0.030, -0.130) * Pose(p.target) * Rz(p.target_rad) * Translation3d(0, 0, 0.080) *
         Rz(p.is_reclamped ? 0.0 : -p.shift_rad) * Pose(p.reference) * Rz(p.reference_rad) *
         Rz(p.is_reclamped ? -p.shift_rad : 0.0) * Translation3d(0, 0.030, 0.050);
}

TEST(RotaryOptics, AgreesWithTheIndependentOracleToOneNanometre) {
  const std::vector<test::OraclePose> poses = test::OraclePoses();
  ASSERT_EQ(poses.size(), 300u);
  for (const Fidelity fidelity : {Fidelity::kTraced, Fidelity::kClosed}) {
    RotaryOpticsParameters parameters = ExampleBench();
    parameters.fidelity = fidelity;
    const RotaryOptics optics(parameters);
    for (const test::OraclePose& pose : poses) {
      const auto [a, b] = optics.Trace(GratingPose(pose), ExampleSource());
      ASSERT_EQ(a.status, PsdStatus::kOk);
      const std::array found_m{a.u_m, a.v_m, b.u_m, b.v_m};
      // Demanded is 1 nm; the table's nine decimals of a micrometre allow 1e-15 m, the sums behind them 1e-14 m.
      for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(found_m[k], pose.spots_m[k], 1e-13) << k;
    }
    EXPECT_EQ(optics.rays_traced(), fidelity == Fidelity::kTraced ? 4u * poses.size() : 0u);
  }
}

TEST(RotaryOptics, ResolvesAMicroArcsecond) {
  const RotaryOptics optics(ExampleBench());
  const double step = 1e-6 * kArcsec;
  const double gain = 0.120 * (1.0 + 1.0 / std::sqrt(1.0 - 0.39 * 0.39));
  const double u0 = optics.Trace(Isometry3d::Identity(), ExampleSource()).a.u_m;
  // Rounding of coordinates of 0.1 m is 1e-17 m, six orders below the 1e-12 m step.
  EXPECT_NEAR((u0 - optics.Trace(Rz(step), ExampleSource()).a.u_m) / (gain * step), 1.0, 1e-4);
}

TEST(RotaryOptics, RotatesTheReadingWithARolledDetectorAndStretchesUWithTiltAboutV) {
  const auto seen = [](const Isometry3d& pose, double roll_rad, double tilt_v_rad) {
    RotaryOpticsParameters parameters = ExampleBench();
    parameters.psd_a.roll_rad = roll_rad;
    parameters.psd_a.tilt_v_rad = tilt_v_rad;
    return RotaryOptics(parameters).Trace(pose, ExampleSource()).a;
  };
  const Isometry3d pose = Pose({20 * kArcsec, -30 * kArcsec, 50 * kArcsec, 1e-6, 2e-6, 3e-6});
  const PsdSignal straight = seen(pose, 0.0, 0.0), rolled = seen(pose, 0.01, 0.0);
  EXPECT_NEAR(rolled.u_m, std::cos(0.01) * straight.u_m + std::sin(0.01) * straight.v_m, 1e-16);
  EXPECT_NEAR(rolled.v_m, -std::sin(0.01) * straight.u_m + std::cos(0.01) * straight.v_m, 1e-16);
  // Similar triangles: the spot 30 um off centre meets a plane tilted by 0.1; second order is 0.1 u / distance.
  const double u_m = seen(Rz(20 * kArcsec), 0.0, 0.0).u_m;
  EXPECT_NEAR(seen(Rz(20 * kArcsec), 0.0, 0.1).u_m, u_m / std::cos(0.1), 3e-5 * std::abs(u_m));
}

TEST(RotaryOptics, TellsWhyThereIsNoReading) {
  RotaryOpticsParameters parameters = ExampleBench();
  const RotaryOptics optics(parameters);
  // 7.5 mm away from the centre, and 12 mm: the package ends at 9 mm.
  for (const double yaw : {0.03, 0.05})
    EXPECT_EQ(optics.Trace(Rz(yaw), ExampleSource()).a.status, PsdStatus::kMissed);
  const Isometry3d aside(Translation3d(0.013, 0, 0));
  EXPECT_EQ(optics.Trace(aside, ExampleSource()).a.status, PsdStatus::kNoLight);  // the laser misses the grating
  EXPECT_EQ(optics.Trace(Rz(std::numbers::pi), ExampleSource()).a.status, PsdStatus::kNoLight);  // its back
  SourceState red = ExampleSource();
  red.wavelength_m = 1700e-9;
  EXPECT_EQ(optics.Trace(Isometry3d::Identity(), red).b.status, PsdStatus::kNoLight);  // evanescent: 1.02 > 1
  SourceState dark = ExampleSource();
  dark.power_W = 0.0;
  EXPECT_EQ(optics.Trace(Isometry3d::Identity(), dark).a.status, PsdStatus::kNoLight);
}

TEST(RotaryOptics, ABlockerThatCutsTheOrderMakesDarknessOnThatDetectorOnly) {
  RotaryOpticsParameters parameters = ExampleBench();
  // Half way to detector A, on the order's line.
  const Isometry3d pose(Translation3d(0.06 * 0.39, 0.06 * std::sqrt(1 - 0.39 * 0.39), 0.0));
  parameters.blockers = {{BoxMesh({-2e-3, -2e-3, -2e-3}, {2e-3, 2e-3, 2e-3}), pose, false}};
  const PsdSignals signals = RotaryOptics(parameters).Trace(Isometry3d::Identity(), ExampleSource());
  EXPECT_EQ(signals.a.status, PsdStatus::kNoLight);
  EXPECT_EQ(signals.b.status, PsdStatus::kOk);
}

TEST(RotaryOptics, AnEdgeInTheBeamPullsTheCentroidAsTheClosedFormSays) {
  RotaryOpticsParameters parameters = ExampleBench();
  parameters.beam = {.kind = BeamKind::kGaussian, .radius_m = 0.5e-3, .divergence_rad = 0.0, .profile = {}};
  // A plate that covers the upper half of the collimated beam, riding on the grating.
  parameters.blockers = {{BoxMesh({-5e-3, 0.01, 0.0}, {5e-3, 0.012, 5e-3}), Isometry3d::Identity(), true}};
  for (const Fidelity fidelity : {Fidelity::kTraced, Fidelity::kClosed}) {
    parameters.fidelity = fidelity;
    const PsdSignal a = RotaryOptics(parameters).Trace(Isometry3d::Identity(), ExampleSource()).a;
    EXPECT_EQ(a.status, PsdStatus::kClipped);
    EXPECT_NEAR(a.power_W, 0.5 * 0.339 * 5e-3, 1e-9);
    // Mean of the lower half of a normal of 0.25 mm: -0.25 mm sqrt(2/pi); equal slices keep the mean exactly.
    EXPECT_NEAR(a.v_m, -0.25e-3 * std::sqrt(2.0 / std::numbers::pi), 1e-9);
  }
}

TEST(RotaryOptics, IrradianceHasTheCentroidAndPowerOfTheSignal) {
  RotaryOpticsParameters parameters = ExampleBench();
  parameters.beam = {.kind = BeamKind::kGaussian, .radius_m = 0.5e-3, .divergence_rad = 0.5e-3, .profile = {}};
  const RotaryOptics optics(parameters);
  const PsdSignals signals = optics.Trace(Rz(200 * kArcsec), ExampleSource());
  const std::vector<IrradianceMap> maps = optics.Irradiance(Rz(200 * kArcsec), ExampleSource(), 128);
  ASSERT_EQ(maps.size(), 2u);
  EXPECT_NEAR(Centroid(maps[0]).u_m, signals.a.u_m, 1e-10);  // float pixels: 1e-7 of the 0.25 mm spot
  EXPECT_NEAR(Centroid(maps[1]).v_m, signals.b.v_m, 1e-10);
  EXPECT_NEAR(Centroid(maps[0]).power_W, signals.a.power_W, 1e-9);
}

TEST(RotaryOptics, RefusesMissingParameters) {
  EXPECT_THROW(RotaryOptics(RotaryOpticsParameters{}), std::invalid_argument);
  RotaryOpticsParameters parameters = ExampleBench();
  parameters.nominal_wavelength_m = 1700e-9;
  EXPECT_THROW(RotaryOptics{parameters}, std::invalid_argument);
}

using Eigen::Isometry3d, Eigen::Vector3d;

Isometry3d AtHeight(double z_m) { return Isometry3d(Eigen::Translation3d(0.0, 0.0, z_m)); }

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
