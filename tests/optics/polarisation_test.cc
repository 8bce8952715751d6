#include "optics/polarisation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

// Closed forms of Jones' calculus. Rays run along -z, p is y, s is x at a splitter inclined by 45 deg about x.
namespace twinbench::optics {
namespace {

using Eigen::Vector3d;

constexpr double kRounding = 1e-15;
const Vector3d kDown = -Vector3d::UnitZ();
const Vector3d kInclined = Vector3d(0.0, -1.0, 1.0) / std::numbers::sqrt2;

WavePlate Plate(double azimuth_rad, double retardance_rad) {
  return {Vector3d(std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0), retardance_rad};
}

/// Share of light polarised along y that has gone through a plate to a mirror and back and then lies along x.
double TurnedBy(const WavePlate& plate) {
  const Field out = Retard(plate, LinearField(kDown, Vector3d::UnitY(), 1.0), kDown);
  const Field back = Retard(plate, OnMirror(out, Vector3d::UnitZ()), Vector3d::UnitZ());
  EXPECT_NEAR(back.squaredNorm(), 1.0, kRounding);
  return std::norm(back.x());
}

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

TEST(Polarisation, LeaksAsTheExtinctionRatiosSay) {
  const PolarisingSplitter splitter{.p_reflected = 0.02, .s_transmitted = 0.001};
  const SplitFields p = OnSplitter(splitter, LinearField(kDown, Vector3d::UnitY(), 1.0), kDown, kInclined);
  const SplitFields s = OnSplitter(splitter, LinearField(kDown, Vector3d::UnitX(), 1.0), kDown, kInclined);
  EXPECT_NEAR(p.transmitted.squaredNorm() / s.transmitted.squaredNorm(), 0.98 / 0.001, 1e-11);
  EXPECT_NEAR(s.reflected.squaredNorm() / p.reflected.squaredNorm(), 0.999 / 0.02, 1e-12);
  // The reflected light runs along -y, its field across it.
  EXPECT_NEAR(std::abs(p.reflected.y()), 0.0, kRounding);
}

TEST(Polarisation, APlateOfAQuarterWaveTurnsLightThatComesBackByARightAngle) {
  constexpr double kQuarter = 0.5 * std::numbers::pi;
  EXPECT_NEAR(TurnedBy(Plate(0.25 * std::numbers::pi, kQuarter)), 1.0, kRounding);
  // To and fro is one plate of twice the retardance: sin^2(2 azimuth) sin^2(retardance).
  for (const double azimuth_rad : {0.1, 0.7, 0.9}) {
    for (const double retardance_rad : {0.4, kQuarter, kQuarter + 0.1}) {
      const double share = std::pow(std::sin(2.0 * azimuth_rad) * std::sin(retardance_rad), 2);
      EXPECT_NEAR(TurnedBy(Plate(azimuth_rad, retardance_rad)), share, kRounding);
    }
  }
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
