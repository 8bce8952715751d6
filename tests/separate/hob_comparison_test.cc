#include <gmock/gmock.h>

#include "tests/separate/hob_bench.h"
#include "twin/benches/hob_transmission/estimators/comparison.h"

namespace twinbench::separate::hob {
namespace {

HobMachine NoisyMachine() {
  return {.transmission = {{1, 10.0, -2.0}, {2, 1.0, 0.5}, {22, 2.0, -1.0}, {44, 0.8, 2.0}},
          .encoder = {{1, 5.8, 2.72}, {2, 0.4, 1.0}},
          .noise_arcsec = 0.5, .interferometer_noise_arcsec = 0.3, .interferometer = true};
}

struct Results {
  HeadSeparation separation;
  HarmonicSeries transmission;  // by the interferometer
  HarmonicSeries encoder;
};

Results Evaluate(const std::vector<HobSample>& samples, int max_order = 60) {
  const TransmissionOptions options = OrdersUpTo(max_order);
  return {SeparateHeads(MeasurePositions(samples, options)),
          TransmissionByInterferometer(MeasurePositions(samples, options, Signal::kInterferometer), 1),
          EncoderByInterferometer(MeasurePositions(samples, options, Signal::kEncodersMinusInterferometer))};
}

TEST(CompareTransmission, AgreesInTheLinesOfTableAndHob) {
  const Results r = Evaluate(Samples(NoisyMachine(), Heads({0.0, 100.0, 223.0})));
  const auto lines = CompareTransmission(r.separation, 1, r.transmission);
  ASSERT_EQ(lines.size(), 3u);
  for (const OrderComparison& c : lines) {
    EXPECT_EQ(c.status, OrderStatus::kSeparated);
    EXPECT_LT(c.normalised_error, 1.5) << c.order;  // 1 is exceeded once in 20
    EXPECT_NEAR(c.amplitude_difference_rad / c.u_amplitude_difference_rad, 0.0, 3.5);
    EXPECT_NEAR(c.phase_difference_rad / c.u_phase_difference_rad, 0.0, 3.5);
    EXPECT_LT(DistanceArcsec(c.reference.value, CoefficientOf(NoisyMachine().transmission, c.order)),
              0.03);  // u: 0.003
  }
  EXPECT_THAT(FindLines(r.transmission), testing::ElementsAre(1, 2, 22, 44));
}

TEST(CompareEncoder, ShowsTheAmplitudeAndPhaseOfThePapersFigure8) {
  const Results r = Evaluate(Samples(
      NoisyMachine(), {{0, 25.0, 1, 0, 3}, {0, 25.0, -1, 1, 3}, {1, 205.0, 1, 0, 3}, {1, 205.0, -1, 1, 3}}));
  const auto one = CompareEncoder(r.separation, r.encoder);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_NEAR(Amplitude(one[0].reference) / kArcsec, 5.8, 0.03);  // u: 0.5 sqrt(2 / 17280) = 0.005
  EXPECT_NEAR(Phase(one[0].reference), 2.72, 0.005);
  EXPECT_LT(one[0].normalised_error, 1.5);
}

TEST(CompareTransmission, SaysThatASumStillHoldsTheEncodersShare) {
  const Results r = Evaluate(Samples(NoisyMachine(), Heads({0.0, 180.0})));
  const auto two = CompareTransmission(r.separation, 1, r.transmission, {2});
  ASSERT_EQ(two.size(), 1u);
  EXPECT_EQ(two[0].status, OrderStatus::kSumOnly);
  EXPECT_GT(two[0].normalised_error, 5.0);  // 0.4 arcsec of the encoder, u = 0.01 arcsec
  EXPECT_LT(DistanceArcsec(two[0].difference.value, CoefficientOf(NoisyMachine().encoder, 2)), 0.05);
  EXPECT_THAT(CompareEncoder(r.separation, r.encoder, {2}), testing::IsEmpty());  // nothing to compare with
}

TEST(CompareOrders, StatesTheScatterOfTheDifferences) {
  HobMachine machine = NoisyMachine();
  machine.samples_per_turn = 150;
  constexpr int kRuns = 200;
  double amplitude2 = 0.0, phase2 = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const Results r = Evaluate(Samples(machine, Heads({0.0, 100.0}), 20 + run), 12);
    const OrderComparison one = CompareTransmission(r.separation, 1, r.transmission, {1}).at(0);
    amplitude2 += std::pow(one.amplitude_difference_rad / one.u_amplitude_difference_rad, 2);
    phase2 += std::pow(one.phase_difference_rad / one.u_phase_difference_rad, 2);
  }
  // 200 squares: 10 %, three times that; scatter estimated with some 30 degrees of freedom adds 7 %.
  EXPECT_NEAR(amplitude2 / kRuns, 1.07, 0.3);
  EXPECT_NEAR(phase2 / kRuns, 1.07, 0.3);
}

TEST(CompareOrders, LeavesOutOrdersThatOneSideDoesNotHave) {
  const Results r = Evaluate(Samples(NoisyMachine(), Heads({0.0, 100.0})));
  EXPECT_THAT(CompareTransmission(r.separation, 1, r.transmission, {0, 1, 88}), testing::SizeIs(1));
  EXPECT_THAT(CompareTransmission(r.separation, 1, HarmonicSeries{}), testing::IsEmpty());
}

TEST(TransmissionByInterferometer, IsEmptyWithoutAnInterferometer) {
  HobMachine machine = NoisyMachine();
  machine.interferometer = false;
  const auto positions = MeasurePositions(Samples(machine, Heads({0.0})), OrdersUpTo(60), Signal::kInterferometer);
  EXPECT_TRUE(positions.empty());
  EXPECT_TRUE(TransmissionByInterferometer(positions, 1).orders.empty());
}

}  // namespace
}  // namespace twinbench::separate::hob
