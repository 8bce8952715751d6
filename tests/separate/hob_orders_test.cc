#include "tests/separate/hob_bench.h"

namespace twinbench::separate::hob {
namespace {

constexpr double kHobTurns = 3.4;  // in one of the table: 17 teeth to 5
constexpr double kHobWave_arcsec = 40.0, kHobPhase_rad = -0.7;
constexpr double kTableWave_arcsec = 14.0;
constexpr int kSamplesATurn = 408;

/// Table and hob of a pass: once per turn of either, and white noise.
std::vector<HobSample> GearedSamples(double turns, std::uint64_t seed, double noise_arcsec) {
  Stream noise(seed, "hob_orders");
  std::vector<HobSample> samples;
  for (int i = 0; i < static_cast<int>(turns * kSamplesATurn); ++i) {
    const double even_rad = kTestTurn_rad * i / kSamplesATurn;
    HobSample s{.setup = 0, .pass = 0, .direction = 1};
    s.head_rad = 0.0;
    s.hob_encoder_rad = kHobTurns * even_rad;
    s.table_encoder_rad = even_rad + kArcsec * (kTableWave_arcsec * std::cos(even_rad) +
                                                kHobWave_arcsec * std::cos(s.hob_encoder_rad + kHobPhase_rad) +
                                                noise_arcsec * noise.Normal());
    samples.push_back(s);
  }
  return samples;
}

TransmissionOptions GearedOptions() {
  TransmissionOptions options = OrdersUpTo(60);
  options.table_turns_per_hob_turn = 1.0 / kHobTurns;
  options.hob_orders = {1, 2};
  return options;
}

/// The table's angle is read with the error of the hob's wave: order 1 moves by 40 arcsec, 2e-4 of 14 arcsec.
constexpr double kBend_arcsec = 0.01;

TEST(HobOrders, AreFoundBesideWholeOrdersOfTheTableThatTheyDoNotInflate) {
  const PositionError seen = MeasurePositions(GearedSamples(5.0, 1, 0.4), GearedOptions()).at(0);
  ASSERT_EQ(seen.of_hob.size(), 2u);
  // White noise of 0.4 arcsec in 2040 samples: 0.4 sqrt(2 / 2040).
  const double u_arcsec = 0.4 * std::sqrt(2.0 / 2040.0);
  const HobOrder& once = seen.of_hob[0];
  EXPECT_EQ(once.times, 1);
  EXPECT_NEAR(AmplitudeUncertainty(once.wave) / kArcsec, u_arcsec, 0.1 * u_arcsec);
  EXPECT_LT(DistanceArcsec(once.wave.value, std::polar(kHobWave_arcsec * kArcsec, kHobPhase_rad)), 4.0 * u_arcsec + kBend_arcsec);
  EXPECT_LT(Amplitude(seen.of_hob[1].wave) / kArcsec, 4.0 * u_arcsec + kBend_arcsec);
  EXPECT_LT(AmplitudeUncertainty(seen.series.At(1)) / kArcsec, 2.0 * u_arcsec);
  EXPECT_NEAR(Amplitude(seen.series.At(1)) / kArcsec, kTableWave_arcsec, 4.0 * u_arcsec + kBend_arcsec);
}

TEST(HobOrders, HaveAnUncertaintyThatHolds) {
  double pull2 = 0.0;
  constexpr int kRuns = 40;
  for (int run = 0; run < kRuns; ++run) {
    const PositionError seen = MeasurePositions(GearedSamples(2.0, 100 + run, 4.0), GearedOptions()).at(0);
    ASSERT_EQ(seen.of_hob.size(), 2u);
    pull2 += Pull2(seen.of_hob[0].wave, std::polar(kHobWave_arcsec * kArcsec, kHobPhase_rad)) / kRuns;
  }
  // A mean of 40 values of chi-squared with 2 degrees of freedom: 2, and 0.32 its standard deviation.
  EXPECT_NEAR(pull2, 2.0, 4.0 * 0.32);
}

TEST(HobOrders, AreNotToldInOneTurnOfTheTable) {
  EXPECT_TRUE(MeasurePositions(GearedSamples(1.0, 1, 0.4), GearedOptions()).at(0).of_hob.empty());
}

}  // namespace
}  // namespace twinbench::separate::hob
