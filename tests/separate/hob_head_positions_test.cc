#include "tests/separate/hob_bench.h"
#include "twin/benches/hob_transmission/estimators/head_positions.h"
#include "twin/core/distributions.h"
#include "twin/separate/order_model.h"

namespace twinbench::separate::hob {
namespace {

std::vector<double> Radians(std::vector<double> deg) {
  for (double& d : deg) d *= units::deg;
  return deg;
}

/// Heads that see every order up to 100: the worst, 79, at 3.26 times the noise of a position.
const std::vector<double> kGoodHeads_deg = {0.0, 100.0, 223.0};

TEST(NoiseFactor, IsTheClosedFormOfTwoHeadsAndInfiniteAtEveryEvenOrderOf180Degrees) {
  for (const double beta_deg : {10.0, 77.0, 170.0, 180.0}) {
    for (int k = 1; k <= 100; ++k) {
      const double sine = std::abs(std::sin(0.5 * k * beta_deg * units::deg));
      const double found = NoiseFactor(k, Radians({37.0, 37.0 + beta_deg}));
      if (sine < 1e-10) {
        EXPECT_TRUE(std::isinf(found)) << beta_deg << ' ' << k;
      } else {
        EXPECT_NEAR(found * 2.0 * sine / std::sqrt(2.0), 1.0, 1e-10) << beta_deg << ' ' << k;  // rounding
      }
    }
  }
  EXPECT_NEAR(NoiseFactor(2, Radians({0.0, 170.0})), 4.07, 0.005);  // sqrt(2) / (2 sin 170 deg)
}

TEST(SecondOrder, IsTheRootMeanSquareOfAnErrorTimesThatOfItsSlope) {
  const auto error_rad = [](double at_rad) { return 3e-5 * std::cos(at_rad) + 2e-6 * std::sin(7.0 * at_rad); };
  const auto slope = [](double at_rad) { return -3e-5 * std::sin(at_rad) + 14e-6 * std::cos(7.0 * at_rad); };
  PositionError position;
  position.series.orders.resize(7, {.value = {0.0, 0.0}});
  position.series.At(1).value = {3e-5, 0.0};
  position.series.At(7).value = {0.0, -2e-6};
  constexpr int kPoints = 64;  // all orders of the squares
  double error2 = 0.0, slope2 = 0.0;
  for (int k = 0; k < kPoints; ++k) {
    error2 += std::pow(error_rad(k * units::turn / kPoints), 2) / kPoints;
    slope2 += std::pow(slope(k * units::turn / kPoints), 2) / kPoints;
  }
  EXPECT_NEAR(harmonics::SecondOrder(position) / std::sqrt(error2 * slope2), 1.0, 1e-12);
}

/// All orders up to 60 in both, of some tenths of an arcsecond, on top of what the paper shows.
HobMachine RichMachine() {
  HobMachine machine{.transmission = {{1, 10.0, -2.0}, {22, 2.0, -1.0}, {44, 0.8, 2.0}},
                     .encoder = {{1, 5.8, 2.72}}};
  for (int k = 1; k <= 60; ++k) {
    machine.transmission.push_back({k, 0.3 + 0.2 * std::sin(1.0 * k), 0.7 * k});
    machine.encoder.push_back({k, 0.2 + 0.1 * std::cos(1.0 * k), 1.3 * k});
  }
  return machine;
}

HeadSeparation Separated(const HobMachine& machine, const std::vector<Mounting>& setups, int max_order = 60,
                         const HeadOptions& options = {}, std::uint64_t seed = 1) {
  return SeparateHeads(MeasurePositions(Samples(machine, setups, seed), OrdersUpTo(max_order)), options);
}

TEST(SeparateHeads, RecoversAllOrdersOfThreePositionsWithoutANullAndTakesNoSecondOrderOfItsOwnForAFinding) {
  const HobMachine machine = RichMachine();
  const HeadSeparation result = Separated(machine, Heads(kGoodHeads_deg));
  ASSERT_EQ(result.orders.size(), 60u);
  for (const SeparatedOrder& order : result.orders) {
    ASSERT_EQ(order.status, OrderStatus::kSeparated) << order.order;
    // Angles are known to the encoder's error only, 6 arcsec = 3e-5 rad, order 44 of 1 arcsec: 1.3e-3; times 3.3.
    EXPECT_LT(DistanceArcsec(order.transmission[0].value, CoefficientOf(machine.transmission, order.order)), 5e-3);
    EXPECT_LT(DistanceArcsec(order.encoder.value, CoefficientOf(machine.encoder, order.order)), 5e-3);
    // Without noise nothing is left but that m is taken where the encoder says the table is.
    EXPECT_GT(ChiSquaredExceedance(order.chi2, order.dof), 0.05) << order.order;
  }
}

TEST(SeparateHeads, GivesTheSumWhereThreeEquidistantPositionsSeeAlike) {
  const HobMachine machine = RichMachine();
  const HeadSeparation result = Separated(machine, Heads({20.0, 140.0, 260.0}));
  for (const SeparatedOrder& order : result.orders) {
    const Complex truth = CoefficientOf(machine.transmission, order.order);
    const Complex encoder = CoefficientOf(machine.encoder, order.order);
    if (order.order % 3 == 0) {
      EXPECT_EQ(order.status, OrderStatus::kSumOnly);
      EXPECT_TRUE(std::isnan(order.transmission[0].value.real()) && std::isnan(order.encoder.value.real()));
      EXPECT_TRUE(std::isinf(order.noise_factor));
      EXPECT_NEAR(std::abs(order.sum[0].share), 1.0, 1e-12);  // all of the encoder's error is in the sum
      EXPECT_EQ(order.dof, 4);                                // three readings of one sum, cos and sin
    } else {
      EXPECT_EQ(order.status, OrderStatus::kSeparated);
      EXPECT_EQ(order.dof, 2);
      EXPECT_LT(DistanceArcsec(order.transmission[0].value, truth), 5e-3) << order.order;
    }
    EXPECT_LT(DistanceArcsec(order.sum[0].sum.value, truth + order.sum[0].share * encoder), 5e-3) << order.order;
  }
}

TEST(SeparateHeads, IsNearlyBlindAtOrderTwoOf177Degrees) {
  HobMachine machine{.transmission = {{2, 1.0, 0.3}}, .encoder = {{2, 0.5, 1.0}}};
  for (const double noise_arcsec : {0.3, 10.0}) {  // u of a position 0.006 and 0.19 arcsec; times 13.5
    machine.noise_arcsec = noise_arcsec;
    const SeparatedOrder two = Separated(machine, Heads({0.0, 177.0})).At(2);
    EXPECT_NEAR(two.noise_factor, 13.51, 0.005);
    EXPECT_EQ(two.status, noise_arcsec < 1.0 ? OrderStatus::kSeparated : OrderStatus::kSumOnly);
    EXPECT_NEAR(std::abs(two.sum[0].share), std::cos(3.0 * units::deg), 1e-6);
    const Complex sum =
        CoefficientOf(machine.transmission, 2) + two.sum[0].share * CoefficientOf(machine.encoder, 2);
    EXPECT_LT(Pull2(two.sum[0].sum, sum), 15.0);  // exp(-7.5) = 0.0006 of noise alone
  }
}

TEST(SeparateHeads, IsNotFooledByReadingsWithoutNoise) {
  const HobMachine machine{.transmission = {{2, 1.0, 0.3}}, .encoder = {{2, 0.5, 1.0}}};
  EXPECT_EQ(Separated(machine, Heads({0.0, 180.0})).At(2).status, OrderStatus::kSumOnly);
  EXPECT_EQ(Separated(machine, Heads({0.0, 179.99})).At(2).status, OrderStatus::kSumOnly);  // 4000 times
}

/// The probability that the positions agree in orders 2 to 60, all together.
double ChanceThatPositionsAgree(const HeadSeparation& result) {
  double chi2 = 0.0, dof = 0.0;
  for (const SeparatedOrder& order : result.orders) {
    if (order.order == 1) continue;
    chi2 += order.chi2_alike;
    dof += order.dof_alike;
  }
  return ChiSquaredExceedance(chi2, dof);
}

TEST(SeparateHeads, FindsThatOrdersTwoAndUpAgreeInThePapersTwoPositions) {
  HobMachine machine = RichMachine();
  machine.encoder = {{1, 5.8, 2.72}};
  machine.noise_arcsec = 0.5;
  HeadSeparation result = Separated(machine, Heads({0.0, 180.0}, 10.0));
  EXPECT_GT(ChanceThatPositionsAgree(result), 0.01);
  EXPECT_LT(ChiSquaredExceedance(result.At(1).chi2_alike, 2), 1e-9);  // but not in order 1
  EXPECT_THAT(FindLines(TransmissionSeries(result, 1)), testing::IsSupersetOf({22, 44}));
  machine.encoder.push_back({3, 0.2, 0.0});  // 0.4 arcsec between the positions, u = 0.009 arcsec
  EXPECT_LT(ChanceThatPositionsAgree(Separated(machine, Heads({0.0, 180.0}, 10.0))), 1e-6);
}

TEST(SeparateHeads, StatesTheScatterOfItsResults) {
  HobMachine machine = RichMachine();
  machine.encoder = {{1, 1.0, 2.72}, {2, 0.5, 1.0}};  // small: second order stays out of the comparison
  machine.transmission = {{1, 2.0, -2.0}, {22, 0.5, -1.0}};
  machine.noise_arcsec = 0.5;
  machine.samples_per_turn = 150;
  machine.missing = 0.03;
  constexpr int kRuns = 150, kOrders = 30;
  Eigen::ArrayXd e2 = Eigen::ArrayXd::Zero(kOrders), stated = e2;
  double pull2 = 0.0, chi2 = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const HeadSeparation result = Separated(machine, Heads({0.0, 30.0, 100.0}, 6.0), kOrders, {}, 70 + run);
    for (const SeparatedOrder& order : result.orders) {
      const int k = order.order;
      ASSERT_EQ(order.status, OrderStatus::kSeparated);
      e2[k - 1] += std::norm(order.transmission[0].value - CoefficientOf(machine.transmission, k));
      stated[k - 1] += order.transmission[0].cov.trace();
      pull2 += Pull2(order.encoder, CoefficientOf(machine.encoder, k));
      chi2 += order.chi2;
    }
  }
  for (int k = 1; k <= kOrders; ++k) {
    EXPECT_NEAR(e2[k - 1] / stated[k - 1], 1.0, 0.3) << k;  // 300 squares: 8 %, 3.5 times that
    // Equal positions: the closed form, against one order's 0.5 sqrt(2 / (0.97 x 900)); gaps cost a little more.
    const double closed_form = NoiseFactor(k, Radians({0.0, 30.0, 100.0})) * 0.5 * std::sqrt(2.0 / (0.97 * 900));
    EXPECT_NEAR(std::sqrt(stated[k - 1] / (2 * kRuns)) / kArcsec / closed_form, 1.0, 0.08) << k;
  }
  // F(2, 50 to 90): mean 2.06, 4500 values with standard deviation 2.1: 0.03.
  EXPECT_NEAR(pull2 / (kRuns * kOrders), 2.06, 0.12);
  EXPECT_NEAR(chi2 / (kRuns * kOrders), 2.06, 0.12);  // three positions leave two degrees of freedom
}

TEST(SeparateHeads, GivesEachDirectionItsTransmissionErrorAndTheRingOneError) {
  HobMachine forward = RichMachine();
  HobMachine backward = forward;
  backward.transmission.push_back({1, 2.0, 0.0});
  backward.transmission.push_back({22, 1.0, 1.0});
  std::vector<HobSample> samples = Samples(forward, Heads(kGoodHeads_deg));
  for (int s = 0; s < 3; ++s) {
    const double head_deg = kGoodHeads_deg[static_cast<std::size_t>(s)];
    for (const HobSample& sample : Samples(backward, {{s, head_deg, -1, 1, 4}})) samples.push_back(sample);
  }
  const HeadSeparation result = SeparateHeads(MeasurePositions(samples, OrdersUpTo(60)));
  EXPECT_THAT(result.directions, testing::ElementsAre(1, -1));
  for (const SeparatedOrder& order : result.orders) {
    const int k = order.order;
    EXPECT_LT(DistanceArcsec(order.transmission[0].value, CoefficientOf(forward.transmission, k)), 5e-3) << k;
    EXPECT_LT(DistanceArcsec(order.transmission[1].value, CoefficientOf(backward.transmission, k)), 5e-3) << k;
    EXPECT_LT(DistanceArcsec(order.encoder.value, CoefficientOf(forward.encoder, k)), 5e-3) << k;
  }
  EXPECT_EQ(TransmissionSeries(result, -1).At(22).value, result.At(22).transmission[1].value);
  EXPECT_EQ(EncoderSeries(result).At(3).value, result.At(3).encoder.value);
}

TEST(SeparateHeads, CannotTellPositionsApartThatWereMeasuredInDifferentDirections) {
  const HeadSeparation result = Separated(RichMachine(), {{0, 0.0, 1, 0, 3}, {1, 180.0, -1, 0, 3}});
  EXPECT_EQ(result.At(1).status, OrderStatus::kSumOnly);
  EXPECT_EQ(result.At(1).dof_alike, 0);
}

TEST(SeparateHeads, ShowsARingThatWasSeatedDifferently) {
  HobMachine machine = RichMachine();
  machine.noise_arcsec = 0.5;
  std::vector<HobSample> samples = Samples(machine, Heads({0.0, 100.0}));
  machine.encoder.push_back({1, 1.0, 0.0});  // 0.25 um on a radius of 50 mm
  for (const HobSample& s : Samples(machine, {{2, 223.0, 1, 0, 4}})) samples.push_back(s);
  const HeadSeparation result = SeparateHeads(MeasurePositions(samples, OrdersUpTo(60)));
  EXPECT_LT(ChiSquaredExceedance(result.At(1).chi2, result.At(1).dof), 1e-6);
  EXPECT_GT(ChiSquaredExceedance(result.At(2).chi2, result.At(2).dof), 1e-3);
}

TEST(SeparateHeads, CountsTheUncertaintyOfTheHeadAngles) {
  const HobMachine machine{.encoder = {{1, 5.8, 2.72}, {3, 5.8, 1.0}}};
  const double u_head_rad = 0.2 * units::deg;
  const HeadSeparation result = Separated(machine, Heads({0.0, 180.0}), 60, {.u_head_rad = u_head_rad});
  for (const int k : {1, 3}) {
    // e_T = (E_1 + E_2) / 2: two independent tangential errors k psi u, halved; nothing along psi.
    const double u_phase_rad = k * u_head_rad / std::sqrt(2.0);
    const double u_rad = 5.8 * kArcsec * u_phase_rad;
    EXPECT_NEAR(LargestUncertainty(result.At(k).transmission[0]), u_rad, 1e-3 * u_rad);
    EXPECT_NEAR(PhaseUncertainty(result.At(k).encoder), u_phase_rad, 1e-3 * u_phase_rad);
    // The floor: slope 12 arcsec x 8 arcsec / 206265 / sqrt(2) = 4e-4 arcsec, of 0.014 arcsec.
    EXPECT_LT(AmplitudeUncertainty(result.At(k).encoder), 0.04 * u_rad);
  }
}

TEST(SeparateHeads, LeavesOutPositionsWithoutATurn) {
  std::vector<Mounting> setups = Heads(kGoodHeads_deg);
  setups[1].turns = 0.5;
  const HeadSeparation result = Separated(RichMachine(), setups);
  EXPECT_EQ(result.positions, 2);
  EXPECT_EQ(result.left_out, 1);
  EXPECT_EQ(result.At(1).status, OrderStatus::kSeparated);
  EXPECT_TRUE(SeparateHeads({}).orders.empty());
}

}  // namespace
}  // namespace twinbench::separate::hob
