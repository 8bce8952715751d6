#include "optics/slope_probe.h"

#include <gtest/gtest.h>

#include "optics/quadrant_detector.h"
#include "optics/triangulation.h"

// A probe over surfaces for which geometry says what it must see: planes, paraboloids, heights of a map.
namespace twinbench::optics {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

constexpr double kLens_m = 0.05;

ProbedSurface Over(const FormedSurface& surface, double tip_above_m, const HeightMap* form = nullptr,
                   const Vector2d& vertex_m = Vector2d::Zero()) {
  return [=, &surface](const RayBatch& rays, SurfacePoints& points) {
    RayBatch lifted = rays;
    for (double& z : lifted.oz) z += tip_above_m;
    surface.Meet(lifted, form, vertex_m, points);
    for (Vector3d& p : points.point_m) p.z() -= tip_above_m;
  };
}

/// A plane mirror through T's origin, its normal at these slopes.
ProbedSurface Mirror(double slope_x, double slope_y) {
  return [=](const RayBatch& rays, SurfacePoints& points) {
    const Vector3d normal = Vector3d(-slope_x, -slope_y, 1.0).normalized();
    points.Resize(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Ray ray = rays.At(i);
      points.is_met[i] = 1;
      points.normal[i] = normal;
      points.point_m[i] = ray.origin_m - ray.origin_m.dot(normal) / ray.direction.dot(normal) * ray.direction;
    }
  };
}

/// Heights that change along x only, from the middle.
HeightMap MapAlongX(int width, int height, double pitch_m, const std::function<double(double x_m)>& height_um) {
  HeightMap map{width, height, pitch_m, {}};
  for (int i = 0; i < width * height; ++i)
    map.height_um.push_back(static_cast<float>(height_um((i % width - width / 2) * pitch_m)));
  return map;
}

double PowerOf(const ProbeView& view, int returns) {
  double power = 0.0;
  for (const ProbePatch& p : view.patches) power += p.returns == returns ? p.power : 0.0;
  return power;
}

TEST(SlopeProbe, ReadsTwiceTheSlopeOfAMirrorAndOfOneTooFarTurnedNoLight) {
  const SlopeProbe probe({.lens_m = kLens_m});
  const double x = 0.004, y = -0.007;
  const ProbeView view = probe.Look(Mirror(x, y));
  ASSERT_EQ(view.patches.size(), 1u);
  const double flat = 1.0 - x * x - y * y;  // 2 n n_z - z of a normal (-x, -y, 1)
  EXPECT_NEAR(view.patches[0].u_m, -2.0 * kLens_m * x / flat, 1e-16);
  EXPECT_NEAR(view.patches[0].v_m, -2.0 * kLens_m * y / flat, 1e-16);
  // Plate and splitter see light that is askew in x and y turned by half the product of its slopes.
  EXPECT_NEAR(view.patches[0].power, 1.0, 4.0 * std::pow(4.0 * x * y / 2.0, 2));
  const ProbeView away = probe.Look(Mirror(0.1, 0.0));
  EXPECT_TRUE(away.is_met);
  EXPECT_TRUE(away.patches.empty());
}

TEST(SlopeProbe, LosesToTheLaserWhatThePlateDoesNotTurn) {
  // To and fro turns cos^2(2 azimuth error) cos^2(retardance error) of the light, which the splitter reflects.
  for (const double azimuth_rad : {0.0, 0.1}) {
    for (const double retardance_rad : {0.0, 0.2}) {
      SlopeProbeParameters p{.lens_m = kLens_m};
      p.plate_azimuth_error_rad = azimuth_rad;
      p.plate_retardance_error_rad = retardance_rad;
      const double turned = std::pow(std::cos(2.0 * azimuth_rad) * std::cos(retardance_rad), 2);
      EXPECT_NEAR(PowerOf(SlopeProbe(p).Look(Mirror(0.0, 0.0)), 1), turned, 1e-14);
      p.splitter.p_reflected = 0.05;
      p.splitter.s_transmitted = 0.01;
      const double reflected = 0.95 * (0.99 * turned + 0.05 * (1.0 - turned));
      EXPECT_NEAR(PowerOf(SlopeProbe(p).Look(Mirror(0.0, 0.0)), 1), reflected, 1e-14);
    }
  }
}

TEST(SlopeProbe, LeaksOnAFixedPlaceWhatThePlatesFacesReflect) {
  constexpr double kFace = 0.0025;
  SlopeProbeParameters p{.lens_m = kLens_m};
  p.plate_reflected = kFace;
  p.plate_tilt_rad = {0.0, 0.002};  // about y: its normal leans towards +x
  for (const double p_reflected : {0.0, 0.02}) {
    p.splitter.p_reflected = p_reflected;
    const SlopeProbe probe(p);
    // What the back face reflects has gone through the plate twice and is turned; what the front face reflects is
    // not, and reaches the detector as far as the splitter leaks.
    const double through = 1.0 - p_reflected;
    const double leaks = through * (kFace * std::pow(1.0 - kFace, 2) + kFace * p_reflected);
    for (const double slope : {0.0, 0.003}) {
      const ProbeView view = probe.Look(Mirror(slope, slope));
      EXPECT_NEAR(PowerOf(view, 0), leaks, 1e-6 * leaks + 1e-7);  // weaker than 1e-7 is not followed
      for (const ProbePatch& patch : view.patches) {
        if (patch.returns != 0) continue;
        EXPECT_NEAR(patch.u_m, kLens_m * std::tan(2.0 * 0.002), 1e-15);
        EXPECT_NEAR(patch.v_m, 0.0, 1e-15);
      }
    }
  }
}

TEST(SlopeProbe, SeesLightThatThePlateSendsBackASecondTimeAtTwiceTheDeflection) {
  SlopeProbeParameters p{.lens_m = kLens_m};
  p.plate_reflected = 0.0025;
  const double slope = 0.002;
  const ProbeView view = SlopeProbe(p).Look(Mirror(slope, 0.0));
  const auto second = std::ranges::find(view.patches, 2, &ProbePatch::returns);
  ASSERT_NE(second, view.patches.end());
  // As strong as the light on the fixed place to first order.
  EXPECT_NEAR(second->power, p.plate_reflected, 0.02 * p.plate_reflected);
  EXPECT_NEAR(second->u_m, -kLens_m * std::tan(4.0 * std::atan(slope)), 1e-15);
}

TEST(SlopeProbe, MakesASpotOfTheBeamsWidthAndItsDiffraction) {
  constexpr double kWaist_m = 0.1e-3, kWavelength_m = 650e-9, kRadius_m = 0.040;
  const FormedSurface bowl(Paraboloid(Eigen::Isometry3d::Identity(), 0.5 * kRadius_m, 0.01));
  const SlopeProbe probe({.lens_m = kLens_m, .beam_radius_m = kWaist_m, .wavelength_m = kWavelength_m});
  const Spot spot = probe.BeamOnDetector(Over(bowl, 0.0));
  // At the waist place and direction are independent: a slope of 2 x / R, and the beam's own.
  const double by_slope_m = kLens_m * 2.0 * kWaist_m / kRadius_m;
  const double by_diffraction_m = kLens_m * kWavelength_m / (std::numbers::pi * kWaist_m);
  const double radius_m = std::hypot(by_slope_m, by_diffraction_m);
  // Powers of the beam's slope, 1e-5, are left out by that formula.
  EXPECT_NEAR(2.0 * std::sqrt(spot.cov_m2(0, 0)), radius_m, 1e-4 * radius_m);
  EXPECT_NEAR(2.0 * std::sqrt(spot.cov_m2(1, 1)), radius_m, 1e-4 * radius_m);
  EXPECT_NEAR(spot.u_m, 0.0, 1e-12);
  EXPECT_NEAR(spot.power_W, 1.0, 1e-14);
}

TEST(SlopeProbe, AveragesHeightsOverTheBeam) {
  // A wave of heights h cos(k x): a beam of 1/e^2 radius w sees its slope less by exp(-k^2 w^2 / 8).
  constexpr double kWaist_m = 0.4e-3, kLength_m = 3e-3, kHeight_um = 0.1;
  const double k = 2.0 * std::numbers::pi / kLength_m;
  const HeightMap map = MapAlongX(481, 81, 0.05e-3, [=](double x_m) { return kHeight_um * std::cos(k * x_m); });
  const FormedSurface flat(Paraboloid(Eigen::Isometry3d::Identity(), 500.0, 0.01));
  const SlopeProbe probe({.lens_m = kLens_m, .beam_radius_m = kWaist_m});
  const double x_m = 0.25 * kLength_m;  // where the wave is steepest
  const auto shift = [&](auto read) {
    return read(Over(flat, 0.0, &map, Vector2d(x_m, 0.0))) - read(Over(flat, 0.0));
  };
  const double point = shift([&](const ProbedSurface& s) { return probe.Look(s).patches.at(0).u_m; });
  const double beam = shift([&](const ProbedSurface& s) { return probe.BeamOnDetector(s).u_m; });
  EXPECT_NEAR(point, 2.0 * kLens_m * kHeight_um * 1e-6 * k, 5e-3 * std::abs(point));  // cubic between pixels
  // Three nodes across integrate the wave to 1 % of what is averaged away.
  EXPECT_NEAR(beam / point, std::exp(-k * k * kWaist_m * kWaist_m / 8.0), 0.002);
}

TEST(FormedSurface, MeetsTheHeightsOnItsForm) {
  // A tilted plane of heights on a bowl: where and how steep is algebra.
  constexpr double kRadius_m = 0.04, kTilt = 2e-4;
  const HeightMap map = MapAlongX(201, 201, 0.1e-3, [](double x_m) { return 1e6 * kTilt * x_m; });
  const FormedSurface bowl(Paraboloid(Eigen::Isometry3d::Identity(), 0.5 * kRadius_m, 0.01));
  RayBatch rays;
  rays.Add({{0.002, -0.001, 0.03}, Vector3d(0.05, 0.02, -1.0).normalized()});
  SurfacePoints points;
  bowl.Meet(rays, &map, Vector2d::Zero(), points);
  ASSERT_TRUE(points.is_met[0]);
  const Vector3d p = points.point_m[0];
  EXPECT_NEAR(p.z(), p.head<2>().squaredNorm() / (2.0 * kRadius_m) + kTilt * p.x(), 2e-13);  // floats in the map
  EXPECT_NEAR((p - rays.At(0).origin_m).normalized().dot(rays.At(0).direction), 1.0, 1e-14);
  const Vector3d normal = Vector3d(-p.x() / kRadius_m - kTilt, -p.y() / kRadius_m, 1.0).normalized();
  EXPECT_LT((points.normal[0] - normal).norm(), 1e-9);
}

TEST(Triangulation, SeesASpotWhereScheimpflugsFormulaSaysAndNotWhatLiesBehindIt) {
  const TriangulationParameters p{.object_m = 0.07, .image_m = 0.05, .alpha_rad = 0.5};
  const Triangulation camera(p);
  const double beta = std::atan(p.object_m * std::tan(p.alpha_rad) / p.image_m);
  for (const double beyond_m : {-0.01, -0.002, 0.0, 1e-6, 0.004, 0.02}) {
    const double expected_m = p.image_m * beyond_m * std::sin(p.alpha_rad) /
                              (p.object_m * std::sin(beta) + beyond_m * std::sin(p.alpha_rad + beta));
    EXPECT_NEAR(camera.Seen_m({0.0, 0.0, -beyond_m}), expected_m, 1e-15);
    // The whole beam is sharp: another part of the lens shows the spot at the same place.
    EXPECT_NEAR(camera.Seen_m({0.0, 0.0, -beyond_m}, {0.003, -0.002}), expected_m, 1e-14);
  }
  EXPECT_TRUE(std::isnan(Triangulation({.object_m = 0.02, .image_m = 0.05, .alpha_rad = 0.5}).Seen_m({0, 0, 0.1})));
  EXPECT_THROW(Triangulation({.object_m = 0.02, .image_m = 0.05, .alpha_rad = 2.0}), std::invalid_argument);
}

TEST(QuadrantDetector, SharesAGaussianSpotByItsErrorFunctionAndTakesAPointWhereItIs) {
  constexpr double kRadius_m = 0.25e-3, kGap_m = 0.02e-3;
  Spot spot{.u_m = 0.08e-3, .v_m = -0.03e-3, .power_W = 2.0};
  spot.cov_m2 = 0.25 * kRadius_m * kRadius_m * Eigen::Matrix2d::Identity();
  const auto side = [&](double at_m) {
    return 0.5 * (1.0 - std::erf(std::numbers::sqrt2 * (0.5 * kGap_m - at_m) / kRadius_m));
  };
  const QuadrantPowers q = OnQuadrants(spot, kGap_m);
  EXPECT_NEAR(q.pp, 2.0 * side(spot.u_m) * side(spot.v_m), 1e-15);
  EXPECT_NEAR(q.mm, 2.0 * side(-spot.u_m) * side(-spot.v_m), 1e-15);
  EXPECT_LT(q.Sum(), 2.0);  // the gap takes some
  const QuadrantPowers point = OnQuadrants({.u_m = 1e-4, .v_m = -1e-4, .power_W = 1.0}, 1e-5);
  EXPECT_EQ(point.pm, 1.0);
  EXPECT_EQ(point.Sum(), 1.0);
}

TEST(QuadrantDetector, KnowsASpotWhoseAxesLieAskew) {
  // Centred and without a gap: a quadrant has 1/4 + asin(correlation) / 2 pi (Sheppard).
  for (const double correlation : {-0.9, -0.3, 0.5, 0.9}) {
    Spot spot{.power_W = 1.0};
    spot.cov_m2 << 4e-8, correlation * 6e-8, correlation * 6e-8, 9e-8;
    const QuadrantPowers q = OnQuadrants(spot, 0.0);
    EXPECT_NEAR(q.pp, 0.25 + std::asin(correlation) / (2.0 * std::numbers::pi), 1e-12);
    EXPECT_NEAR(q.Sum(), 1.0, 1e-12);
    // Anywhere: both halves are those of one coordinate alone.
    spot.u_m = 1.3e-4, spot.v_m = -0.7e-4;
    const QuadrantPowers off = OnQuadrants(spot, 0.0);
    EXPECT_NEAR(off.pp + off.pm, 0.5 * std::erfc(-spot.u_m / std::sqrt(2.0 * 4e-8)), 1e-12);
    EXPECT_NEAR(off.pp + off.mp, 0.5 * std::erfc(-spot.v_m / std::sqrt(2.0 * 9e-8)), 1e-12);
  }
}

}  // namespace
}  // namespace twinbench::optics
