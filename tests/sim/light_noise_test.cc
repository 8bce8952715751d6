#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/quiet_scenario.h"
#include "tests/support/night.h"
#include "twin/benches/rotary_4dof/twin/speckle.h"
#include "twin/benches/rotary_4dof/twin/twin.h"
#include "twin/core/units.h"
#include "twin/sim/beam_wander.h"
#include "twin/sim/flicker_noise.h"

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

/// Allan variance of means over `tau_s`, from seconds of its own for each seed. Of flicker noise with power
/// spectral density h / f it is 2 ln 2 h whatever tau is; one decade holds h ln 10 (IEEE Std 1139).
double AllanVariance(double tau_s, int seeds) {
  double sum = 0.0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const FlickerNoise noise(1.0, static_cast<std::uint64_t>(seed), "test");
    constexpr int kPairs = 10, kSamples = 200;
    for (int pair = 0; pair < kPairs; ++pair) {
      double difference = 0.0;
      for (int k = 0; k < kSamples; ++k) {
        const double t_s = (2.0 * pair + (k + 0.5) / kSamples) * tau_s;
        difference += (noise.At(t_s + tau_s) - noise.At(t_s)) / kSamples;
      }
      sum += 0.5 * difference * difference / (kPairs * seeds);
    }
  }
  return sum;
}

TEST(FlickerNoise, HasTheSameAllanVarianceOverSecondsAndMinutes) {
  const double expected = 2.0 * std::log(2.0) / std::log(10.0);
  const int seeds = test::ByNight(200, 50);
  for (const double tau_s : {1.0, 10.0, 60.0})  // four standard deviations, of some correlated pairs
    EXPECT_NEAR(AllanVariance(tau_s, seeds), expected, 0.12 * std::sqrt(200.0 / seeds) * expected);
}

TEST(FlickerNoise, IsNothingIfNotAskedFor) {
  EXPECT_EQ(FlickerNoise(0.0, 1, "test").At(3.0), 0.0);
  EXPECT_TRUE(std::isinf(FlickerNoise(0.0, 1, "test").Shortest_s()));
}

/// Of the mean over `corners` periods of the corner: integral of the stated spectrum times sinc^2(pi f T), by
/// Simpson over the logarithm of the frequency; 0: of a single value.
double VarianceOfMean(double corners) {
  constexpr int kIntervals = 20000;
  const double from = std::log(BeamWander::kLowest), to = std::log(BeamWander::kHighest);
  double total = 0.0, mean = 0.0;
  for (int k = 0; k <= kIntervals; ++k) {
    const double x = std::exp(from + (to - from) * k / kIntervals);
    const double weight = k == 0 || k == kIntervals ? 1.0 : (k % 2 == 1 ? 4.0 : 2.0);
    const double density = weight * std::cbrt(x) / (1.0 + x * x), y = units::kPi * x * corners;
    total += density;
    mean += density * (y == 0.0 ? 1.0 : std::pow(std::sin(y) / y, 2));
  }
  return mean / total;
}

class Means : public testing::TestWithParam<double> {};

TEST_P(Means, ScatterAsTheSpectrumSays) {
  constexpr int kWanders = 4000, kPoints = 100;
  const double corner_Hz = 50.0, duration_s = GetParam() / corner_Hz;
  double squares = 0.0;
  for (int seed = 0; seed < kWanders; ++seed) {
    const BeamWander wander(3.0, corner_Hz, static_cast<std::uint64_t>(seed), "test");
    double mean = 0.0;
    for (int k = 0; k < kPoints; ++k) mean += wander.At((k + 0.5) / kPoints * duration_s) / kPoints;
    squares += mean * mean / kWanders;
  }
  const double expected = 9.0 * VarianceOfMean(GetParam());
  EXPECT_NEAR(squares, expected, 5.0 * std::sqrt(2.0 / kWanders) * expected);
}

INSTANTIATE_TEST_SUITE_P(FromATenthToFourPeriodsOfTheCorner, Means, testing::Values(0.0, 0.1, 1.0, 4.0));

int Blocks() {
  return test::ByNight(1500, 400);
}

/// Mean of squares of the means of blocks of so many scans on one channel, minutes apart.
double SquareOfMeans_V2(int scans, int channel) {
  Scenario scenario = OnlyTheLightsNoise();
  RotaryOf(scenario).optics.wander_rad = 100e-6;
  RotaryOf(scenario).optics.wander_corner_Hz = 200.0;
  Twin twin(scenario);
  const int blocks = Blocks();
  double squares_V2 = 0.0;
  for (int k = 0; k < blocks; ++k) {
    squares_V2 += std::pow(twin.Bench().adc.Acquire(scans, false).channel[channel].mean_V, 2) / blocks;
    twin.Bench().clock.Wait(FromSeconds(1.73));
  }
  return squares_V2;
}

// Up and down: the pitch at the laser over the whole way, and what the arm's own air does.
TEST(BeamWander, GrowsWithTheWayAndIsLeftInBlockMeansAsItsSpectrumSays) {
  const double way_m = 0.2, arm_m = 0.12;
  const double by_laser_m = 100e-6 * std::sqrt(way_m) * (way_m + arm_m),
               by_arm_m = 100e-6 * std::sqrt(arm_m) * arm_m;
  const double single_V2 = std::pow(2000.0 * std::hypot(by_laser_m, by_arm_m), 2);
  const double tolerance = 5.0 * std::sqrt(2.0 / Blocks()) * 1.3;  // neighbours are not quite independent
  EXPECT_NEAR(SquareOfMeans_V2(1, 1) / single_V2, 1.0, tolerance);
  const double block_s = 1250 * 16e-6;  // four periods of the corner
  EXPECT_NEAR(SquareOfMeans_V2(1250, 3) / single_V2 / VarianceOfMean(200.0 * block_s), 1.0, tolerance);
}

TEST(BeamWander, IsNoneInARunWithoutNoise) {
  Scenario scenario = Quiet();
  RotaryOf(scenario).optics.wander_rad = 100e-6;
  EXPECT_EQ(Twin(scenario).Bench().adc.Acquire(100, false).channel[0].std_V, 0.0);
}

}  // namespace
}  // namespace twinbench::sim
