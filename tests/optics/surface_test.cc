#include <gtest/gtest.h>

#include <random>

#include "optics/polarisation.h"
#include "tests/optics/example_bench.h"

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

using Eigen::Matrix2d, Eigen::Vector2d;

/// Largest centroid shift over all phases of the interference.
double LargestShift_um(const Vector2d& gradient, double reflectance, double sigma_m) {
  double largest = 0.0;
  for (int i = 0; i < 720; ++i) {
    const Etalon etalon =
        Interfere(reflectance, i * kDegree / 2, gradient, sigma_m * sigma_m * Matrix2d::Identity());
    largest = std::max(largest, std::abs(etalon.shift_m.x()));
  }
  return largest * 1e6;
}

double LargestShift_um(double wedge_arcsec, double reflectance, double sigma_m) {
  const auto phase = EtalonPhase(Glass(wedge_arcsec * kArcsec), 650e-9, Vector3d(0, 0, -1), 0.0, Matrix2d::Zero());
  return LargestShift_um(phase.second, reflectance, sigma_m);
}

TEST(Etalon, HasTheSizesOfTheDesignStudyAndOfAParallelWindowActsThroughTheWavefront) {
  // Two digits are given there, for two-beam interference; the higher reflections add about R = 4 %.
  EXPECT_NEAR(LargestShift_um(1, 0.042, 0.25e-3), 0.74, 0.04);
  EXPECT_NEAR(LargestShift_um(10, 0.042, 0.25e-3), 7.0, 0.3);
  EXPECT_NEAR(LargestShift_um(60, 0.042, 0.25e-3), 4.6, 0.2);
  EXPECT_NEAR(LargestShift_um(10, 0.005, 0.25e-3), 0.83, 0.02);
  EXPECT_NEAR(LargestShift_um(10, 0.001, 0.25e-3), 0.17, 0.005);
  EXPECT_NEAR(LargestShift_um(60, 0.042, 0.5e-3), 0.02, 0.005);
  // Wavefront radius 5 m, window tilted by 1 deg: 0.23 um.
  const Vector3d d(std::sin(kDegree), 0.0, -std::cos(kDegree));
  const auto [phase, gradient] = EtalonPhase(Glass(), 650e-9, d, 0.0, Matrix2d::Identity() / 5.0);
  EXPECT_NEAR(LargestShift_um(gradient, 0.042, 0.25e-3), 0.23, 0.01);
  EXPECT_TRUE(std::isfinite(phase));
}

TEST(Etalon, IsTheAveragedAiryFunction) {
  // Brute-force average of (1-R)^2 / (1 - 2 R cos + R^2) over a Gaussian patch.
  const double reflectance = 0.3, phase = 1.1, gradient = 6000.0, sigma = 0.2e-3;
  double weight = 0.0, power = 0.0, moment = 0.0;
  for (int i = -4000; i <= 4000; ++i) {
    const double x = i * 2e-3 * sigma, g = std::exp(-0.5 * x * x / (sigma * sigma));
    const double cosine = std::cos(phase + gradient * x);
    const double airy = std::pow(1 - reflectance, 2) / (1 - 2 * reflectance * cosine + reflectance * reflectance);
    weight += g;
    power += g * airy;
    moment += g * airy * x;
  }
  const Etalon etalon = Interfere(reflectance, phase, Vector2d(gradient, 0), sigma * sigma * Matrix2d::Identity());
  EXPECT_NEAR(etalon.transmission, power / weight, 1e-12);
  EXPECT_NEAR(etalon.shift_m.x(), moment / power, 1e-15);
}

TEST(Refract, ObeysSnell) {
  const double angle = 0.4;
  const Refracted out = Refract({std::sin(angle), 0, -std::cos(angle)}, Vector3d::UnitZ(), 1.0 / 1.5);
  EXPECT_NEAR(out.direction.x(), std::sin(angle) / 1.5, 1e-16);
  EXPECT_NEAR(out.direction.norm(), 1.0, 1e-15);
  EXPECT_TRUE(Refract({std::sin(1.0), 0, -std::cos(1.0)}, Vector3d::UnitZ(), 1.5).total_reflection);
}

TEST(WindowFaces, AreThickerTowardsPositiveU) {
  const auto faces = WindowFaces(Glass(1e-3), Eigen::Isometry3d::Identity(), 0.01, 0.01);
  const auto height = [](const Surface& s, double u) { return 1.0 - Meet(s, {{u, 0, 1}, {0, 0, -1}}, 0.0).t_m; };
  EXPECT_NEAR(height(faces.second, 0.0) - height(faces.first, 0.0), 1e-3, 1e-15);
  EXPECT_NEAR(height(faces.second, 2e-3) - height(faces.first, 2e-3), 1e-3 + 2e-6, 1e-15);
}

// Closed forms of Jones' calculus. Rays run along -z, p is y, s is x at a splitter inclined by 45 deg about x.

constexpr double kRounding = 1e-15;
const Vector3d kDown = -Vector3d::UnitZ();
const Vector3d kInclined = Vector3d(0.0, -1.0, 1.0) / std::numbers::sqrt2;

TEST(Polarisation, AnalysedByASplitterFollowsMalus) {
  for (const double angle_rad : {0.0, 0.3, 1.0, 1.5}) {
    const Field light = LinearField(kDown, {std::sin(angle_rad), std::cos(angle_rad), 0.0}, 2.0);
    const SplitFields split = OnSplitter({}, light, kDown, kInclined);
    EXPECT_NEAR(split.transmitted.squaredNorm(), 2.0 * std::pow(std::cos(angle_rad), 2), 4.0 * kRounding);
    EXPECT_NEAR(split.reflected.squaredNorm(), 2.0 * std::pow(std::sin(angle_rad), 2), 4.0 * kRounding);
  }
}

TEST(Polarisation, OfLayersLeaksWhatComesAskewAndOfWiresDoesNot) {
  // A ray along -z turned about y by t has its plane of incidence turned by t: light polarised along y leaks t^2.
  constexpr double kAskew = 1e-3;
  const Vector3d direction = Vector3d(kAskew, 0.0, -1.0).normalized();
  const Field light = LinearField(direction, Vector3d::UnitY(), 1.0);
  const double layers = OnSplitter({}, light, direction, kInclined).reflected.squaredNorm();
  EXPECT_NEAR(layers, kAskew * kAskew, 1e-5 * kAskew * kAskew);
  const PolarisingSplitter wires{.wires = Vector3d::UnitX()};
  EXPECT_LT(OnSplitter(wires, light, direction, kInclined).reflected.squaredNorm(), 1e-24);
}

TEST(Polarisation, OnAMirrorStaysAcrossItsRayAndHasNoFieldAlongIt) {
  const Vector3d direction = Vector3d(0.1, 0.2, -1.0).normalized(), normal = Vector3d(0.3, -0.1, 1.0).normalized();
  const Vector3d reflected = direction - 2.0 * direction.dot(normal) * normal;
  const Field field = Retard({Vector3d::UnitX(), 0.7}, LinearField(direction, {1.0, 1.0, 0.0}, 1.0), direction);
  const Field out = OnMirror(field, normal);
  EXPECT_NEAR(std::abs(out.dot(reflected.cast<std::complex<double>>())), 0.0, kRounding);
  EXPECT_NEAR(out.squaredNorm(), 1.0, kRounding);
  EXPECT_THROW(LinearField(kDown, Vector3d::UnitZ(), 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace twinbench::optics
