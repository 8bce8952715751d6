#include "tests/core/input_error.h"
#include "tests/separate/hob_bench.h"
#include "tests/support/kept_text.h"
#include "tests/support/over_seeds.h"
#include "twin/benches/hob_transmission/estimators/turn_fit.h"

namespace twinbench::separate::hob {
namespace {

/// Angles are taken at the encoder's reading, off by psi: order 44 of 1 arcsec moves by 44 x 1 x 1e-5 at 2 arcsec.
constexpr double kSecondOrder_arcsec = 2e-3;

HobMachine Machine() {
  return {.transmission = {{1, 10.0, 0.5}, {2, 1.0, 1.0}, {22, 2.0, -1.0}, {44, 1.0, 2.0}},
          .encoder = {{1, 1.5, 2.72}, {3, 0.5, 0.2}}};
}

/// Without what the ring errs, so that nothing but the sampling is left.
HobMachine OfATrueRing(double noise_arcsec = 0.0, int samples_per_turn = 1440) {
  HobMachine machine = Machine();
  machine.encoder.clear();
  machine.noise_arcsec = noise_arcsec;
  machine.samples_per_turn = samples_per_turn;
  return machine;
}

/// The one position of a head at 0.
PositionError OfOneHead(const HobMachine& machine, int max_order = 60, double turns = 4.0, std::uint64_t seed = 1) {
  return MeasurePositions(Samples(machine, Heads({0.0}, turns), seed), OrdersUpTo(max_order)).at(0);
}

/// Equation 1 in orders: e_T + psi exp(-j k head).
Complex Expected(const HobMachine& machine, int order, double head_deg) {
  return CoefficientOf(machine.transmission, order) +
         CoefficientOf(machine.encoder, order) * std::polar(1.0, -order * head_deg * units::deg);
}

void ExpectOrders(const PositionError& position, const HobMachine& machine, double head_deg,
                  double tolerance_arcsec) {
  ASSERT_EQ(position.status, PositionStatus::kOk);
  for (int k = 1; k <= position.series.Highest(); ++k) {
    EXPECT_LT(DistanceArcsec(position.series.At(k).value, Expected(machine, k, head_deg)), tolerance_arcsec)
        << "order " << k << " mounting " << position.setup << " direction " << position.direction;
  }
}

TEST(MeasurePositions, FindsTheOrdersOfEachSetUpAndDirection) {
  const std::vector<Mounting> setups = {
      {0, 20.0, 1, 0, 3}, {0, 20.0, -1, 1, 3}, {1, 200.0, 1, 0, 3}, {1, 200.0, -1, 1, 3}};
  const auto positions = MeasurePositions(Samples(Machine(), setups), OrdersUpTo(60));
  ASSERT_EQ(positions.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(positions[i].setup, setups[i].setup);
    EXPECT_EQ(positions[i].direction, setups[i].direction);
    EXPECT_EQ(positions[i].turns, 3);
    ExpectOrders(positions[i], Machine(), setups[i].head_deg, kSecondOrder_arcsec);
  }
}

TEST(MeasurePositions, IsNotBiasedByMissingSamplesJitterOrSpeed) {
  HobMachine machine = OfATrueRing(0.0, 400);
  for (const auto& [missing, jitter, speed] :
       std::vector<std::array<double, 3>>{{0.1, 0, 0}, {0, 0.4, 0}, {0, 0, 0.1}, {0.1, 0.3, 0.1}}) {
    machine.missing = missing;
    machine.jitter = jitter;
    machine.speed_change = speed;
    const PositionError position = OfOneHead(machine);
    ExpectOrders(position, machine, 0.0, 1e-6);  // rounding of the hob's 600 rad: 1e-13 rad = 2e-8 arcsec
    EXPECT_EQ(position.turns, 4);
  }
}

TEST(MeasurePositions, SkipsSamplesWithoutAngle) {
  std::vector<HobSample> samples = Samples(Machine(), Heads({0.0}));
  for (std::size_t i = 5; i < samples.size(); i += 11)
    (i % 2 ? samples[i].hob_encoder_rad : samples[i].table_encoder_rad) = kNaN;
  const auto positions = MeasurePositions(samples, OrdersUpTo(60));
  ExpectOrders(positions.at(0), Machine(), 0.0, kSecondOrder_arcsec);
  EXPECT_EQ(positions.at(0).samples, 4 * 1440 - 524);  // 5 + 11 i < 5760
}

TEST(MeasurePositions, LeavesOutTurnsWithAWideGapAndTheTurnThatWasNotFinished) {
  std::vector<HobSample> samples = Samples(Machine(), Heads({0.0}));
  samples.erase(samples.begin() + 1440 + 300, samples.begin() + 1440 + 400);  // 25 deg of the second turn
  const PositionError gap = MeasurePositions(samples, OrdersUpTo(60)).at(0),
                      unfinished = OfOneHead(Machine(), 60, 2.6);
  EXPECT_EQ(gap.turns, 3);
  EXPECT_EQ(unfinished.turns, 2);
  for (const PositionError& position : {gap, unfinished}) EXPECT_EQ(position.turns_left_out, 1);
  ExpectOrders(gap, Machine(), 0.0, kSecondOrder_arcsec);
  EXPECT_EQ(OfOneHead(Machine(), 60, 0.6).status, PositionStatus::kNoTurn);
}

// A counter that latches at lines gives angles a whole turn apart, but for the rounding of their decimals.
TEST(MeasurePositions, TakesEveryTurnOfLinesThatLieWholeTurnsApart) {
  constexpr int kTurns = 5, kLines = 30, kStarts = 200;  // orders 1 to 14 need 29 of them
  constexpr double kStep_deg = 360.0 / kLines;
  for (int start = 0; start < kStarts; ++start) {
    const int direction = start % 2 == 0 ? 1 : -1;
    std::vector<HobSample> samples;
    for (int k = 0; k < kTurns * kLines; ++k) {
      HobSample sample{.direction = direction, .head_rad = 0.0};
      sample.table_encoder_rad = (0.02 * start + direction * k * kStep_deg) * units::deg;
      sample.hob_encoder_rad = 10.0 * sample.table_encoder_rad;
      samples.push_back(sample);
    }
    TransmissionOptions options = OrdersUpTo(14);
    options.table_turns_per_hob_turn = 0.1;
    const auto positions = MeasurePositions(samples, options);
    EXPECT_EQ(positions.at(0).turns, kTurns) << "start " << start;
    EXPECT_EQ(positions.at(0).turns_left_out, 0) << "start " << start;
  }
}

TEST(MeasurePositions, CountsInUWhatFewSamplesATurnFoldOntoTheOrders) {
  HobMachine machine{.transmission = {{1, 9.8, 1.3}, {2, 1.6, 3.5}, {3, 0.7, 1.2}}};
  machine.noise_arcsec = 0.05;
  for (const auto& [samples, folds] : {std::pair(4, true), {720, false}}) {
    machine.samples_per_turn = samples;
    const PositionError position = OfOneHead(machine, 1);
    EXPECT_EQ(position.of_folding_rad2 > 0.0, folds) << samples;
    const double off_arcsec = DistanceArcsec(position.series.At(1).value, CoefficientOf(machine.transmission, 1));
    EXPECT_EQ(off_arcsec > 0.5, folds) << samples;  // order 3
    EXPECT_LT(off_arcsec, 2.0 * LargestUncertainty(position.series.At(1)) / units::arcsec) << samples;
  }
}

// At lines of the table the hob stands where it stood a turn ago: its counts err alike in every turn.
TEST(MeasurePositions, StatesWhatCoarseCountsOfTheHobRepeatInEveryTurn) {
  constexpr double kStep_rad = units::turn / 16384.0;
  constexpr int kRuns = 8, kOrders = 60;
  for (const double noise_arcsec : {0.02, 0.1}) {
    const HobMachine machine = OfATrueRing(noise_arcsec, 720);
    const Eigen::Array2d of_stated = test::MeanOverSeeds(kRuns, [&](std::uint64_t run) {
      std::vector<HobSample> samples = Samples(machine, Heads({0.0}), run);
      for (HobSample& s : samples)
        s.hob_encoder_rad = kStep_rad * std::round(s.hob_encoder_rad / kStep_rad + static_cast<double>(run) / kRuns);
      TransmissionOptions options = OrdersUpTo(kOrders);
      const PositionError scatter = MeasurePositions(samples, options).at(0);
      options.hob_step_rad = kTestRatio * kStep_rad;
      const PositionError counted = MeasurePositions(samples, options).at(0);
      Eigen::Array2d of_run(0.0, 0.0);
      for (int k = 1; k <= kOrders; ++k) {
        const Eigen::Array2d stated_rad2(counted.series.At(k).cov.trace(), scatter.series.At(k).cov.trace());
        of_run += std::norm(counted.series.At(k).value - Expected(machine, k, 0.0)) / kOrders / stated_rad2;
      }
      return of_run;
    });
    EXPECT_THAT(of_stated[0], testing::AllOf(testing::Gt(0.25), testing::Lt(4.0))) << noise_arcsec;
    EXPECT_GT(of_stated[1], 10.0) << noise_arcsec;
  }
}

TEST(MeasurePositions, StatesTheScatterOfTheMeanOfItsTurns) {
  const HobMachine machine = OfATrueRing(0.5, 720);
  constexpr int kOrders = 60;
  const double u_arcsec = 0.5 * std::sqrt(2.0 / (4 * 720));  // white noise, 4 turns
  const Eigen::Array2d mean = test::MeanOverSeeds(60, [&](std::uint64_t seed) {
    const PositionError position = OfOneHead(machine, kOrders, 4.0, seed);
    EXPECT_EQ(position.scatter, ScatterSource::kBetweenTurns);
    EXPECT_NEAR(position.residual_rms_rad / kArcsec, 0.5, 0.05);  // of 2400 samples: 1.4 %, seven times that
    Eigen::Array2d pull2_and_variance(0.0, 0.0);
    for (int k = 1; k <= kOrders; ++k)
      pull2_and_variance += Eigen::Array2d(Pull2(position.series.At(k), CoefficientOf(machine.transmission, k)),
                                           0.5 * position.series.At(k).cov.trace()) / kOrders;
    return pull2_and_variance;
  });
  // Mean variance: 3600 coefficients with 54 degrees of freedom each, neighbours pooled: 1 %. The drift adds to low
  // orders.
  EXPECT_NEAR(std::sqrt(mean[1]) / (u_arcsec * kArcsec), 1.0, 0.03);
  // F(2, 54): mean of the pull 2 x 54 / 52 = 2.08, standard deviation of the mean of 3600 about 2.1 / 60 = 0.035.
  EXPECT_NEAR(mean[0], 2.08, 0.12);
}

TEST(MeasurePositions, TakesTheScatterWithinASingleTurn) {
  HobMachine machine = Machine();
  machine.noise_arcsec = 0.5;
  const PositionError position = OfOneHead(machine, 60, 1.0);
  EXPECT_EQ(position.scatter, ScatterSource::kWithinTurn);
  const double u_arcsec = 0.5 * std::sqrt(2.0 / 1440);
  // 1319 degrees of freedom: 2 %, four times that.
  EXPECT_NEAR(LargestUncertainty(position.series.At(22)) / (u_arcsec * kArcsec), 1.0, 0.08);
}

TEST(MeasurePositions, TakesASteadyDriftOut) {
  HobMachine machine = OfATrueRing();
  machine.drift_arcsec_per_turn = 3.0;
  for (const int direction : {1, -1}) {
    const auto three = MeasurePositions(Samples(machine, {{0, 0.0, direction, 0, 3.0}}), OrdersUpTo(60));
    EXPECT_NEAR(three.at(0).drift_rad_per_turn / kArcsec, 3.0, 1e-6);  // rounding
    ExpectOrders(three.at(0), machine, 0.0, 1e-6);
    // Two turns do not tell a drift; it stays with the amplitude drift / (pi k).
    const auto two = MeasurePositions(Samples(machine, {{0, 0.0, direction, 0, 2.0}}), OrdersUpTo(60));
    EXPECT_TRUE(std::isnan(two.at(0).drift_rad_per_turn));
    const double left_arcsec = DistanceArcsec(two.at(0).series.At(1).value, CoefficientOf(machine.transmission, 1));
    EXPECT_NEAR(left_arcsec, 3.0 / units::kPi, 0.01);  // orders above 60, sampled: 1 / 1440
  }
}

TEST(MeasurePositions, TakesNoCountsThatWereLostBetweenTwoRunsOfTurnsForADrift) {
  const HobMachine machine = OfATrueRing();
  std::vector<HobSample> samples = Samples(machine, Heads({0.0}, 5.0));
  constexpr double kLost_rad = 1e-3, kBetween_rad = 20.0 * kTestTurn_rad;
  for (auto s = samples.begin() + 2 * machine.samples_per_turn; s != samples.end(); ++s)
    s->table_encoder_rad += kBetween_rad, s->hob_encoder_rad += (kBetween_rad + kLost_rad) / kTestRatio;
  ExpectOrders(MeasurePositions(samples, OrdersUpTo(60)).at(0), machine, 0.0, 1e-6);
}

/// Moves the hob's reading of each turn by a constant of its own: what a drift cannot be told from.
void ShiftTurns(std::vector<HobSample>& samples, int per_turn, double sd_arcsec, Stream& stream) {
  double shift_rad = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i % static_cast<std::size_t>(per_turn) == 0) shift_rad = sd_arcsec * kArcsec * stream.Normal();
    samples[i].hob_encoder_rad -= shift_rad / kTestRatio;
  }
}

TEST(MeasurePositions, CountsTheUncertaintyOfTheDrift) {
  const HobMachine machine{.transmission = {{1, 10.0, 0.5}}, .noise_arcsec = 0.05, .samples_per_turn = 200};
  Stream stream(9, "shifts");
  const Eigen::Array2d found_and_stated = test::MeanOverSeeds(400, [&](std::uint64_t seed) {
    std::vector<HobSample> samples = Samples(machine, Heads({0.0}), seed);
    ShiftTurns(samples, 200, 1.0, stream);
    const auto once = MeasurePositions(samples, OrdersUpTo(10)).at(0).series.At(1);
    return Eigen::Array2d(std::norm(once.value - CoefficientOf(machine.transmission, 1)), once.cov.trace());
  });
  // The slope over four turns has the uncertainty 1 / sqrt(5) arcsec a turn, 1 / pi of it in order 1.
  EXPECT_NEAR(std::sqrt(found_and_stated[0]) / kArcsec, 1.0 / (std::sqrt(5.0) * units::kPi), 0.02);
  // 400 squares over 400 estimates with two degrees of freedom: 7 and 5 %, three times that.
  EXPECT_NEAR(found_and_stated[0] / found_and_stated[1], 1.0, 0.26);
}

TEST(FitTurn, SaysHowMuchAGapCosts) {
  const Eigen::VectorXd whole = Eigen::VectorXd::LinSpaced(400, 0.0, kTestTurn_rad * 399.0 / 400.0);
  const auto inflation = [&](int missing) {
    const Eigen::VectorXd rest = whole.head(400 - missing);
    return FitTurn(rest, Eigen::VectorXd::Zero(rest.size()), 0.0, 1, 30).inflation;
  };
  // Gaps well below pi / 30 = 6.7 samples cost little more than their samples, twice that much costs the turn.
  EXPECT_LT(inflation(3), 1.2);
  EXPECT_GT(inflation(40), 4.0);
}

TEST(FitTurn, IsNotDeterminedByTooFewSamples) {
  const Eigen::VectorXd angle_rad = Eigen::VectorXd::LinSpaced(61, 0.0, kTestTurn_rad * 60.0 / 61.0);
  EXPECT_FALSE(FitTurn(angle_rad.head(60), Eigen::VectorXd::Zero(60), 0.0, 1, 30).determined);
  EXPECT_TRUE(FitTurn(angle_rad, Eigen::VectorXd::Zero(61), 0.0, 1, 29).determined);
}

/// The same problem with cosines and sines and a plain inverse.
Eigen::MatrixXd PlainInverse(const Eigen::VectorXd& angle_rad, int max_order) {
  Eigen::MatrixXd design(angle_rad.size(), 2 * max_order + 1);
  design.col(0).setOnes();
  for (int k = 1; k <= max_order; ++k) {
    design.col(2 * k - 1) = (k * angle_rad.array()).cos();
    design.col(2 * k) = -(k * angle_rad.array()).sin();
  }
  return (design.transpose() * design).inverse();
}

TEST(FitTurn, StatesTheCovarianceOfIrregularSamples) {
  Stream stream(3, "angles");
  Eigen::VectorXd angle_rad(53);
  for (int i = 0; i < 53; ++i) angle_rad[i] = kTestTurn_rad * (i + 0.8 * stream.Uniform()) / 60;
  const TurnFit fit = FitTurn(angle_rad, Eigen::VectorXd::Zero(53), 0.0, 1, 15);
  const Eigen::MatrixXd expected = PlainInverse(angle_rad, 15);
  for (int k = 1; k <= 15; ++k) {
    const Eigen::Matrix2d block = expected.block<2, 2>(2 * k - 1, 2 * k - 1);
    const Eigen::Matrix2d& stated = fit.cofactor[static_cast<std::size_t>(k - 1)];
    EXPECT_LT((stated - block).norm(), 1e-9 * block.norm()) << k;  // rounding times the condition
  }
}

TEST(MeasurePositions, CountsFromTheReferenceMarkIfTold) {
  HobMachine machine = Machine();
  std::vector<HobSample> samples = Samples(machine, Heads({37.0}));
  for (HobSample& s : samples) s.table_encoder_rad -= 37.0 * units::deg;  // zero where the mark passes the head
  TransmissionOptions options = OrdersUpTo(60);
  options.zero = EncoderZero::kReferenceMark;
  ExpectOrders(MeasurePositions(samples, options).at(0), machine, 37.0, kSecondOrder_arcsec);
}

TEST(MeasurePositions, ResamplesTheMeanAtRegularAngles) {
  HobMachine machine = OfATrueRing();
  machine.missing = 0.1;
  const Eigen::VectorXd mean_rad = Resample(OfOneHead(machine).series, 360);
  for (int i = 0; i < 360; ++i)
    EXPECT_NEAR(mean_rad[i] / kArcsec, ValueOf(machine.transmission, i * units::deg) / kArcsec, 1e-5);  // rounding
}

TEST(ResampledUncertainty, IsTheRootOfTheOrdersVariances) {
  HobMachine machine = Machine();
  machine.noise_arcsec = 0.5;
  const Eigen::VectorXd u_rad = ResampledUncertainty(OfOneHead(machine).series, 36);
  // 60 orders of variance 2 sigma^2 / (4 x 1440) each, whatever the angle; scatter known to some per cent.
  EXPECT_NEAR(u_rad.mean() / kArcsec, 0.5 * std::sqrt(60 * 2.0 / (4 * 1440)), 0.01);
}

TEST(FindLines, RaisesFalseAlarmsAsOftenAsAsked) {
  const HobMachine machine{.noise_arcsec = 0.5, .samples_per_turn = 300};
  const double alarms = test::MeanOverSeeds(200, [&](std::uint64_t seed) {
    return static_cast<double>(FindLines(OfOneHead(machine, 40, 4.0, seed).series, 0.2).size());
  });
  EXPECT_NEAR(alarms, 0.2, 0.125);  // standard deviation 0.03; orders at the ends have fewer neighbours
}

TEST(MeasurePositions, RefusesAnglesThatWrapWrongRatiosHeadsThatMoveOrAreMissingAndADirectionThatIsNone) {
  const std::vector<HobSample> right = Samples(Machine(), Heads({10.0}, 1.0));
  std::vector<HobSample> wrapped = Samples(Machine(), Heads({0.0})), moved = right, missing = right;
  for (HobSample& s : wrapped) s.table_encoder_rad = std::fmod(s.table_encoder_rad, kTestTurn_rad);
  moved[7].head_rad += 1e-3;
  missing[7].head_rad = kNaN;
  TransmissionOptions wrong{.table_turns_per_hob_turn = 2.0 / 43.0};
  EXPECT_KEPT(MessageOf([&] { MeasurePositions(Samples(Machine(), Heads({0.0})), wrong); }));
  const auto turned = Samples(Machine(), {{0, 10.0, 1, 0, 1}, {0, 11.0, -1, 1, 1}});
  const auto aimless = Samples(Machine(), {{0, 10.0, 0, 0, 1}});
  for (const std::vector<HobSample>& samples : {wrapped, turned, moved, missing, aimless})
    EXPECT_KEPT(MessageOf([&] { MeasurePositions(samples, {}); }));
}

}  // namespace
}  // namespace twinbench::separate::hob
