#include "twin/sim/beam_wander.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/quiet_scenario.h"
#include "tests/support/night.h"
#include "twin/benches/rotary_4dof/twin/twin.h"
#include "twin/core/units.h"

namespace twinbench::sim {
namespace {

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
  constexpr int kSeeds = 4000, kPoints = 100;
  const double corner_Hz = 50.0, duration_s = GetParam() / corner_Hz;
  double squares = 0.0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const BeamWander wander(3.0, corner_Hz, static_cast<std::uint64_t>(seed), "test");
    double mean = 0.0;
    for (int k = 0; k < kPoints; ++k) mean += wander.At((k + 0.5) / kPoints * duration_s) / kPoints;
    squares += mean * mean / kSeeds;
  }
  const double expected = 9.0 * VarianceOfMean(GetParam());
  EXPECT_NEAR(squares, expected, 5.0 * std::sqrt(2.0 / kSeeds) * expected);
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
    twin.Bench().clock.Wait(FromSeconds(17.3));
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
