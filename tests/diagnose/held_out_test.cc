#include "twin/diagnose/held_out.h"

#include <gtest/gtest.h>

#include <cmath>

#include "twin/core/stream.h"

// Sums as MeasureGain makes them, of errors whose truth is known.
namespace twinbench::diagnose {
namespace {

struct Held {
  double power = 150.0;      // of the cause, in units of the noise: 600 readings, 0.5 of a deviation each
  double explained = 1.0;    // share of the cause's amplitude that the model has
  double noise = 1.0;        // true deviation over the stated one
  double correlation = 0.0;  // of neighbouring noise
  double fraction() const { return 1.0 - (1.0 - explained) * (1.0 - explained); }
};

/// 50 blocks of twelve readings; the cause is a slow wave.
std::vector<HeldOutSums> Blocks(const Held& held, std::uint64_t seed) {
  constexpr int kReadings = 600, kBlock = 12;
  Stream stream(seed, "held_out_test");
  std::vector<HeldOutSums> blocks(kReadings / kBlock);
  double noise = stream.Normal(), last = kNaN;
  for (int i = 0; i < kReadings; ++i) {
    const double innovation = std::sqrt(1.0 - held.correlation * held.correlation);
    if (i > 0) noise = held.correlation * noise + innovation * stream.Normal();
    const double signal = std::sqrt(2.0 * held.power / kReadings) * std::cos(0.05 * i);
    const double before = held.noise * noise + signal, after = before - held.explained * signal;
    HeldOutSums& block = blocks[static_cast<std::size_t>(i / kBlock)];
    block += {before * before, after * after, 1.0, 1.0};
    if (i > 0) block += {.steps = 0.5 * (after - last) * (after - last), .pairs = 1.0};
    last = after;
  }
  return blocks;
}

struct Found {
  double mean = 0.0;     // of the fraction
  double covered = 0.0;  // share of the runs whose interval has the truth
  double positive = 0.0;
};

Found Over(const Held& held, bool noise_is_stated, double stated_correlation = 0.0) {
  constexpr int kRuns = 120;
  Found found;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    Gain gain;
    FillGain(Blocks(held, seed), noise_is_stated, stated_correlation, gain);
    const auto [lower, upper] = gain.interval95;
    found.mean += gain.fraction_removed / kRuns;
    found.covered += lower <= held.fraction() && held.fraction() <= upper ? 1.0 / kRuns : 0.0;
    found.positive += gain.positive ? 1.0 / kRuns : 0.0;
  }
  return found;
}

TEST(HeldOut, FractionIsRightOnAverageAlsoWhereTheNoiseIsLargerThanTheCause) {
  // The deflation scatters by sqrt(2 * 600) = 35 where 150 can be removed: 0.23 a run, 0.02 of the mean of 120.
  for (const double explained : {1.0, 0.7, 0.3}) {
    const Held held{.explained = explained};
    const Found found = Over(held, true);
    EXPECT_NEAR(found.mean, held.fraction(), 0.05) << explained;
    EXPECT_GE(found.covered, 0.90) << explained;  // 0.95 less two and a half deviations of 120 runs
    EXPECT_GT(found.positive, 0.999) << explained;
  }
}

TEST(HeldOut, NoiseThatIsOnlyEstimatedDoesNotCountAsRemovedOrLeft) {
  // With a noise that is 10 % larger than stated 0.21 * 600 would be left of 150: a fraction of 0.54.
  for (const double noise : {0.9, 1.1}) {
    EXPECT_GT(std::abs(Over({.noise = noise}, true).mean - 1.0), 0.3) << noise;
    const Found found = Over({.noise = noise}, false);
    EXPECT_NEAR(found.mean, 1.0, 0.05) << noise;
    EXPECT_GE(found.covered, 0.90) << noise;
  }
  EXPECT_NEAR(Over({.explained = 0.3}, false).mean, 0.51, 0.05);
}

TEST(HeldOut, CorrelatedNoiseIsNoRemainder) {
  // Neighbours differ by less than their noise says; ignored, 0.3 * 600 of 150 would be left.
  EXPECT_NEAR(Over({.power = 600.0, .correlation = 0.3}, false, 0.3).mean, 1.0, 0.05);
  EXPECT_LT(Over({.power = 600.0, .correlation = 0.3}, false).mean, 0.85);
}

TEST(HeldOut, NothingRemovedIsNoGain) {
  const Found found = Over({.power = 0.0}, true);
  EXPECT_EQ(found.positive, 0.0);
  Gain gain;
  FillGain({{4.0, 4.0, 5.0, 1.0}}, true, 0.0, gain);  // below the floor: nothing to remove
  EXPECT_TRUE(std::isnan(gain.fraction_removed));
  EXPECT_FALSE(gain.positive);
}

TEST(HeldOut, RmsIsInUnitsOfTheReadings) {
  Gain gain;
  FillGain({{16.0, 4.0, 1.0, 1e12}}, true, 0.0, gain);  // one row with a noise of 1 um
  EXPECT_NEAR(gain.before_m, 4e-6, 1e-18);
  EXPECT_NEAR(gain.after_m, 2e-6, 1e-18);
  EXPECT_NEAR(gain.noise_floor_m, 1e-6, 1e-18);
  EXPECT_NEAR(gain.fraction_removed, 12.0 / 15.0, 1e-12);
}

}  // namespace
}  // namespace twinbench::diagnose
