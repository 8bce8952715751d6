#include "twin/sim/flicker_noise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/night.h"

namespace twinbench::sim {
namespace {

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

}  // namespace
}  // namespace twinbench::sim
