#include "twin/benches/rotary_4dof/twin/speckle.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/quiet_scenario.h"
#include "tests/support/night.h"
#include "twin/benches/rotary_4dof/twin/twin.h"

namespace twinbench::sim {
namespace {

constexpr double kRms_m = 2e-6, kCorrelation_rad = 130.0 * units::arcsec;

GratingSettings Rough() {
  GratingSettings grating;
  grating.speckle_m = kRms_m;
  grating.speckle_correlation_rad = kCorrelation_rad;
  return grating;
}

Pose Turned(double yaw_rad, double tilt_rad) {
  Pose pose = Pose::Identity();
  pose.rotate(Eigen::AngleAxisd(yaw_rad, Vector3::UnitZ()) * Eigen::AngleAxisd(tilt_rad, Vector3::UnitX()));
  return pose;
}

std::array<double, kChannels> Displacement_m(std::uint64_t seed, const Pose& X_LG) {
  std::array<double, kChannels> spots_m{};
  Speckle(Rough(), seed).Move(X_LG, spots_m);
  return spots_m;
}

const int kSeeds = test::ByNight(4000, 1000);

/// Over many gratings and all channels: mean of the product at two turns, over the stated variance.
double Correlation(const Pose& a, const Pose& b) {
  double sum = 0.0;
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(kSeeds); ++seed) {
    const auto at_a_m = Displacement_m(seed, a), at_b_m = Displacement_m(seed, b);
    for (std::size_t c = 0; c < kChannels; ++c) sum += at_a_m[c] * at_b_m[c] / (kChannels * kSeeds);
  }
  return sum / (kRms_m * kRms_m);
}

TEST(Speckle, HasTheStatedSizeAndCorrelation) {
  const Pose start = Turned(40.0 * units::arcsec, -70.0 * units::arcsec);
  const double tolerance = 5.0 * std::sqrt(2.0 / (kChannels * kSeeds));
  EXPECT_NEAR(Correlation(start, start), 1.0, tolerance);
  for (const double turn : {0.3, 1.0, 2.0}) {
    const double expected = std::exp(-turn * turn), turn_rad = turn * kCorrelation_rad;
    const Pose yawed = Turned(40.0 * units::arcsec + turn_rad, -70.0 * units::arcsec);
    const Pose both = Turned(40.0 * units::arcsec + 0.6 * turn_rad, -70.0 * units::arcsec + 0.8 * turn_rad);
    EXPECT_NEAR(Correlation(start, yawed), expected, tolerance) << turn;
    EXPECT_NEAR(Correlation(start, both), expected, tolerance) << turn;
  }
}

TEST(Speckle, IsNormalAndOfItsOwnOnEveryChannel) {
  double fourth = 0.0, product = 0.0;
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(kSeeds); ++seed) {
    const auto spots_m = Displacement_m(seed, Turned(0.0, 0.0));
    for (const double spot_m : spots_m) fourth += std::pow(spot_m / kRms_m, 4) / (kChannels * kSeeds);
    product += spots_m[0] * spots_m[2] / (kRms_m * kRms_m) / kSeeds;
  }
  EXPECT_NEAR(fourth, 3.0, 5.0 * std::sqrt(96.0 / (kChannels * kSeeds)));
  EXPECT_NEAR(product, 0.0, 5.0 / std::sqrt(double(kSeeds)));
}

TEST(Speckle, ComesBackWithTheAngle) {
  Scenario scenario = Quiet();
  RotaryOf(scenario).grating = Rough();
  Twin twin(scenario);
  RotaryBench bench = twin.Bench();
  const auto look_V = [&](double yaw_rad) {
    bench.goniometer.MoveTo(yaw_rad, 0.0);
    return bench.adc.Acquire(4, false).channel[1].mean_V;  // a yaw alone does not lift a spot so much
  };
  const double first_V = look_V(0.0), away_V = look_V(200.0 * units::arcsec);
  EXPECT_NEAR(look_V(0.0), first_V, 1e-12);
  EXPECT_GT(std::abs(away_V - first_V), 0.1 * 2000.0 * kRms_m);
}

TEST(Ruling, ShowsWhereABeamMeetsTheGratingBesideItsMiddle) {
  Scenario scenario = Quiet();
  RotaryOf(scenario).laser.position_m.x() = 2e-3;
  const double before_V = Twin(scenario).Bench().adc.Acquire(4, false).channel[0].mean_V;
  RotaryOf(scenario).grating.ruling_chirp_per_m = 50e-6 / units::mm;
  const double after_V = Twin(scenario).Bench().adc.Acquire(4, false).channel[0].mean_V;
  const double cosine = std::sqrt(1.0 - 0.39 * 0.39), turned_rad = 2.0 * 50e-6 * 0.39 / cosine;
  // The spot lies 2 mm cos aside on its detector: the way to it is as long, seen from there.
  EXPECT_NEAR(after_V - before_V, -2000.0 * 0.12 * turned_rad, 0.02 * 2000.0 * 0.12 * turned_rad);
}

}  // namespace
}  // namespace twinbench::sim
