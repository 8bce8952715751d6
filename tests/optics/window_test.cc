#include "optics/window.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/optics/example_bench.h"

namespace twinbench::optics {
namespace {

using Eigen::Matrix2d, Eigen::Vector2d, Eigen::Vector3d;

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

}  // namespace
}  // namespace twinbench::optics
