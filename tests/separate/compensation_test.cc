#include "twin/separate/compensation.h"

#include "tests/core/input_error.h"
#include "tests/separate/index_spectrum.h"
#include "tests/support/kept_text.h"
#include "tests/support/night.h"
#include "tests/support/noise.h"
#include "tests/support/over_seeds.h"
#include "twin/report/compensation_text.h"
#include "twin/separate/line_search.h"

namespace twinbench::separate {
namespace {

using testing::ElementsAre;
using units::arcsec, units::deg;

TEST(LeftByInterpolation, IsThatOfStraightLinesBetweenSamplesOfAWave) {
  for (const int order : {1, 7, 40}) {
    constexpr int kPoints = 100, kFine = 200;
    double squares = 0.0;
    for (int i = 0; i < kPoints * kFine; ++i) {
      const double x = static_cast<double>(i) / kFine, left = std::floor(x);
      const auto wave = [&](double at) { return std::cos(2.0 * units::kPi * order * at / kPoints + 0.3); };
      const double line = wave(left) + (x - left) * (wave(left + 1.0) - wave(left));
      squares += std::pow(line - wave(x), 2) / (kPoints * kFine);
    }
    EXPECT_NEAR(LeftByInterpolation(order, kPoints), std::sqrt(2.0 * squares), 1e-4);  // of 200 parts of an entry
  }
}

TEST(Compensate, LeavesNothingOfCertainLinesWithoutNoise) {
  SpectrumBench bench = BenchWith({{1, 7, 0.4}, {2, 3, 1.0}, {90, 1, 2.0}}, 0.0);
  const std::vector<ReadingPlan> plan = {EvenPositions(), Between(1)};
  const IndexErrors first = bench.Read(plan);
  const Compensation compensation = Compensate(first);
  EXPECT_THAT(compensation.Orders(LineFate::kCompensated), ElementsAre(1, 2, 90));
  EXPECT_EQ(compensation.table.position_rad.size(), 2160u);  // 22 entries a period of order 90, whole degrees
  bench.commanded = compensation.table;
  // Products of the error with its own slope (7 arcsec times 90 times 1 arcsec): some milliarcseconds.
  EXPECT_LT(RootMeanSquare(AboutGroups(first, bench.Read(plan).value_rad)), 5e-3 * arcsec);
}

TEST(Compensate, GoesOnFromACompensationThatWasAtWork) {
  SpectrumBench bench = BenchWith({{1, 7, 0.4}}, 0.05 * arcsec);
  CompensationTable half;  // of the error
  for (int i = 0; i < 360; ++i) {
    half.position_rad.push_back(i * deg);
    half.correction_rad.push_back(-0.5 * ValueOf(bench.lines, i * deg));
  }
  bench.commanded = half;
  const Compensation compensation = Compensate(bench.Read({EvenPositions()}));
  EXPECT_NEAR(compensation.table.At(1.0), -ValueOf(bench.lines, 1.0), 0.02 * arcsec);
}

TEST(Compensate, RefusesWhatATableOfFewEntriesCannotFollow) {
  const SpectrumBench bench = BenchWith({{1, 7, 0.4}, {90, 1, 2.0}}, 0.1 * arcsec);
  CompensationOptions options{.points = 200};
  const Compensation compensation = Compensate(bench.Read({EvenPositions(), Between(1)}), options);
  EXPECT_THAT(compensation.Orders(LineFate::kCompensated), ElementsAre(1));
  EXPECT_THAT(compensation.Orders(LineFate::kTooFine), ElementsAre(90));
  EXPECT_EQ(compensation.table.position_rad.size(), 200u);
  options.points = 3;
  EXPECT_KEPT(MessageOf([&] { Compensate(bench.Read({EvenPositions()}), options); }));
}

TEST(Compensate, AddsNothingWhereNothingIs) {
  const SpectrumBench bench = BenchWith({}, 0.3 * arcsec, 7);
  const Compensation compensation = Compensate(bench.Read({EvenPositions()}));
  EXPECT_TRUE(compensation.lines.empty());
  for (const double correction_rad : compensation.table.correction_rad) EXPECT_EQ(correction_rad, 0.0);
}

/// An axis that is driven to where its own encoder shows even angles: it stands off these by just what the encoder errs, which
/// the sine of order 72 of 72 places shows a ten-thousandth of.
TEST(Compensate, TakesNoOrderThatThePlacesHardlyShow) {
  std::vector<IndexReading> readings;
  test::Noise noise(0.3 * arcsec, 5);
  for (int i = 0; i < 72; ++i) {
    const double error_rad = 30.0 * arcsec * std::cos(i * 5.0 * deg + 0.7);
    readings.push_back({0, i * 5.0 * deg - error_rad, -error_rad + noise()});
  }
  const Compensation compensation = Compensate(MeansByPlace(readings));
  ASSERT_THAT(compensation.Orders(LineFate::kCompensated), ElementsAre(1));
  EXPECT_EQ(compensation.lines.size(), 1u);
  EXPECT_NEAR(compensation.lines.front().line.Amplitude_rad(), 30.0 * arcsec, 0.2 * arcsec);
  EXPECT_LT(compensation.remaining.predicted_rms_rad, 0.5 * arcsec);
}

TEST(Compensate, RefusesAnOrderThatIsAnotherOneEveryTurn) {
  IndexErrors errors = BenchWith({{1, 5, 0.4}, {2, 9, 1.0}}, 0.1 * arcsec).Read({EvenPositions()});
  errors.u_order_rad = {3.5 * arcsec, 1.0 * arcsec};
  const Compensation compensation = Compensate(errors);
  EXPECT_THAT(compensation.Orders(LineFate::kChanging), ElementsAre(1));
  EXPECT_THAT(compensation.Orders(LineFate::kCompensated), ElementsAre(2));
  EXPECT_NEAR(compensation.lines.front().line.u_rad, 3.5 * arcsec, 1e-12);
}

TEST(CompensationText, SaysWhatTheTableLeaves) {
  IndexErrors errors = BenchWith({{2, 9, 1.0}}, 0.1 * arcsec).Read({EvenPositions()});
  errors.reversal_rad = 30.0 * arcsec;
  errors.u_reversal_rad = 0.1 * arcsec;
  errors.u_reading_rad = 5.0 * arcsec;  // repeats of a place that play moved
  const Compensation compensation = Compensate(errors);
  EXPECT_KEPT(report::CompensationText(errors, compensation));
  EXPECT_THAT(report::CompensationComments(errors, compensation, "RUN"), testing::Contains(testing::HasSubstr("30.000")));
}

TEST(CheckCompensation, RefusesARunWithAnotherTable) {
  const SpectrumBench bench = BenchWith({{1, 7, 0.4}}, 0.1 * arcsec);
  const IndexErrors first = bench.Read({EvenPositions()});
  const Compensation compensation = Compensate(first);
  EXPECT_KEPT(MessageOf([&] { CheckCompensation(first, compensation, first); }));
}

/// Over many seeds with lines at gear, drive and bearing orders up to 200.
struct Outcome {
  int mistaken = 0;  // orders compensated that are not there
  int compensated = 0;
};

/// What is left is what was predicted and less than before, between the positions as well, where an order that was taken for another
/// would show; and of lines above what the places tell apart there is a warning.
/// @param highest_told  Orders from here on look like others, or are seen by half.
Outcome Measure(const std::vector<ReadingPlan>& plans, int highest_told) {
  const std::vector<ReadingPlan> checks = {Between(1)};
  Outcome outcome;
  for (int seed = 1; seed <= test::ByNight(200, 25); ++seed) {
    SpectrumBench bench = DrawBench(static_cast<std::uint64_t>(seed), 5);
    const IndexErrors first = bench.Read(plans);
    const IndexErrors check_before = bench.Read(checks);
    const Compensation compensation = Compensate(first);
    bench.commanded = compensation.table;
    const CompensationCheck check = CheckCompensation(first, compensation, bench.Read(plans));
    const IndexErrors check_after = bench.Read(checks);
    EXPECT_NEAR(check.Ratio(), 1.0, 0.2) << seed;
    EXPECT_TRUE(check.IsBetter()) << seed;
    EXPECT_LE(RootMeanSquare(AboutGroups(check_after, check_after.value_rad)),
              RootMeanSquare(AboutGroups(check_before, check_before.value_rad)))
        << seed;
    const auto is_above = [&](const Wave& line) { return line.order >= highest_told; };
    EXPECT_TRUE(compensation.IsAliased() || std::ranges::none_of(bench.lines, is_above)) << seed;
    for (const int order : compensation.Orders(LineFate::kCompensated)) {
      const auto is_it = [order](const Wave& line) { return line.order == order; };
      outcome.mistaken += std::ranges::none_of(bench.lines, is_it);
      ++outcome.compensated;
    }
  }
  return outcome;
}

TEST(Compensate, PredictsWhatIsLeftAtEvenPositionsAndWithReadingsBetweenAllOrHalfOfThem) {
  const Outcome even = Measure({EvenPositions()}, 36);
  // Nothing there tells order 6 from 150: the prior does, which errs once in twenty.
  EXPECT_LT(even.mistaken, even.compensated / 10);
  EXPECT_EQ(Measure({EvenPositions(), Between(1)}, 160).mistaken, 0);
  const Outcome half = Measure({EvenPositions(), Between(2)}, 160);
  // Three and more lines of orders 72 m +- k show as many others as well: these readings have three phases a step.
  EXPECT_LT(half.mistaken, half.compensated / 50);
}

/// Few places and many lines: what is left is as much the lines' own uncertainty as the noise.
TEST(Compensate, PredictsTheUncertaintyOfItsOwnLinesToo) {
  CompensationOptions options;
  options.search.highest_order = 30;
  constexpr int kLines = 12;  // a sixth of the places, the most that are looked for
  const double mean_ratio = test::MeanOverSeeds(60, [&](std::uint64_t seed) {
    SpectrumBench bench = BenchWith({}, 2.0 * arcsec, seed);
    for (int order = 1; order <= kLines; ++order) bench.lines.push_back({order, 100.0 / order, 0.7 * order});
    const IndexErrors first = bench.Read({EvenPositions()});
    const Compensation compensation = Compensate(first, options);
    EXPECT_EQ(compensation.Orders(LineFate::kCompensated).size(), static_cast<std::size_t>(kLines)) << seed;
    bench.commanded = compensation.table;
    return CheckCompensation(first, compensation, bench.Read({EvenPositions()})).Ratio();
  });
  EXPECT_NEAR(mean_ratio, 1.0, 0.04);  // 0.86 without it
}

std::vector<int> OrdersOf(const LineFit& fit) {
  std::vector<int> orders;
  for (const IndexLine& line : fit.lines) orders.push_back(line.order);
  return orders;
}

TEST(FindLines, FindsKnownLinesAndTheirPhasesWithoutNoise) {
  const std::vector<Wave> lines = {{1, 7, 0.4}, {18, 1, 2.0}, {90, 0.5, -1.0}};
  const LineFit fit = FindLines(BenchWith(lines, 0.0).Read({EvenPositions(), Between(1)}));
  ASSERT_EQ(OrdersOf(fit), (std::vector<int>{1, 18, 90}));
  for (std::size_t i = 0; i < 3; ++i) {
    // Second order of the error itself: the table stands where its error has brought it.
    EXPECT_NEAR(fit.lines[i].cos_rad, lines[i].amplitude_arcsec * arcsec * std::cos(lines[i].phase_rad), 1e-4 * arcsec);
    EXPECT_NEAR(fit.lines[i].sin_rad, -lines[i].amplitude_arcsec * arcsec * std::sin(lines[i].phase_rad), 1e-4 * arcsec);
    EXPECT_TRUE(fit.lines[i].is_certain);
  }
}

TEST(FindLines, FindsNothingInNoise) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    found += static_cast<int>(FindLines(BenchWith({}, 0.3 * arcsec, seed).Read({EvenPositions()})).lines.size());
  }
  // Odds of 20 : 1 for a line and a prior that makes lines rare: one in a hundred spectra is expected at most.
  EXPECT_LE(found, 3);
}

TEST(FindLines, DoesNotTakeOrder90ForOrder18At72Positions) {
  const SpectrumBench bench = BenchWith({{1, 7, 0.4}, {90, 1, 2.0}}, 0.1 * arcsec, 2);
  const LineFit even = FindLines(bench.Read({EvenPositions()}));
  ASSERT_EQ(OrdersOf(even), (std::vector<int>{1, 18}));
  EXPECT_TRUE(even.lines[0].is_certain);
  EXPECT_FALSE(even.lines[1].is_certain);
  std::vector<int> alike;
  for (const AlikeOrder& other : even.lines[1].alike) alike.push_back(other.order);
  EXPECT_EQ(alike, (std::vector<int>{54, 90, 126, 162, 198}));  // 72 m +- 18
  const LineFit between = FindLines(bench.Read({EvenPositions(), Between(2)}));
  ASSERT_EQ(OrdersOf(between), (std::vector<int>{1, 90}));
  EXPECT_TRUE(between.lines[1].is_certain);
}

TEST(FindLines, SaysWhichOrdersThePlacesDoNotShow) {
  const SpectrumBench bench = BenchWith({{1, 7, 0.4}}, 0.1 * arcsec, 3);
  const LineFit even = FindLines(bench.Read({EvenPositions()}));
  EXPECT_EQ(even.unseen, (std::vector<int>{36, 72, 108, 144, 180}));
  EXPECT_EQ(std::ssize(even.doubled), 198);  // all but 72 and 144, which look like a constant
  const LineFit degrees = FindLines(bench.Read({EvenPositions(), Between(1)}));
  EXPECT_EQ(degrees.unseen, (std::vector<int>{180}));  // its sine is 0 at whole degrees
  EXPECT_EQ(degrees.doubled.front(), 160);             // looks like 200
  EXPECT_EQ(std::ssize(degrees.doubled), 40);
}

TEST(FindLines, IsNotCertainOfALineThatIsHalfSeen) {
  const SpectrumBench bench = BenchWith({{180, 1, 0.3}}, 0.1 * arcsec, 4);
  const LineFit fit = FindLines(bench.Read({EvenPositions(), Between(1)}));
  ASSERT_EQ(OrdersOf(fit), (std::vector<int>{180}));
  EXPECT_TRUE(fit.lines[0].is_half_seen);
  EXPECT_FALSE(fit.lines[0].is_certain);
}

TEST(FindLines, StatesAnUncertaintyThatMatchesItsScatter) {
  const double mean = test::MeanOverSeeds(200, [](std::uint64_t seed) {
    const LineFit fit = FindLines(BenchWith({{2, 3, 0.0}}, 0.3 * arcsec, seed).Read({EvenPositions()}));
    return std::pow(fit.lines.at(0).sin_rad / fit.lines.at(0).u_rad, 2);
  });
  // chi-squared of one degree of freedom: mean 1, standard deviation sqrt(2 / 200) = 0.1.
  EXPECT_NEAR(mean, 1.0, 0.3);
}

TEST(FindLines, RefusesFewPlaces) {
  IndexErrors errors = MeansByPlace({{0, 0.0, 1.0}, {0, 1.0, 2.0}});
  EXPECT_KEPT(MessageOf([&] { FindLines(errors); }));
}

TEST(MeansByPlace, TakesTheConstantsOfSetUpsFromCommonPlaces) {
  // Value = place + set-up, exactly; the third set-up meets the second at one place only.
  const auto value = [](int setup, double angle_deg) { return angle_deg + 1000.0 * setup * setup; };
  std::vector<IndexReading> readings;
  for (const double at : {0.0, 90.0, 180.0}) readings.push_back({0, at * deg, value(0, at)});
  for (const double at : {90.0, 180.0, 270.0}) readings.push_back({1, at * deg, value(1, at)});
  for (const double at : {270.0, 300.0}) readings.push_back({2, (at - 360.0) * deg, value(2, at)});
  const IndexErrors errors = MeansByPlace(readings);
  ASSERT_EQ(errors.Count(), 5);
  const std::vector<double> places_deg = {0.0, 90.0, 180.0, 270.0, 300.0};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(errors.position_rad[i], places_deg[i] * deg, 1e-7);
    EXPECT_NEAR(errors.value_rad[static_cast<Eigen::Index>(i)] - errors.value_rad[0], places_deg[i], 1e-9);
    EXPECT_EQ(errors.group[i], errors.group[0]);
  }
  EXPECT_EQ(errors.count, (std::vector<int>{1, 2, 2, 2, 1}));
}

TEST(MeansByPlace, KeepsSetUpsApartThatHaveNoPlaceInCommon) {
  const IndexErrors errors = MeansByPlace({{0, 0.0, 1.0}, {0, 1.0, 3.0}, {4, 2.0, 100.0}, {4, 3.0, 104.0}});
  EXPECT_EQ(errors.group[0], errors.group[1]);
  EXPECT_EQ(errors.group[2], errors.group[3]);
  EXPECT_NE(errors.group[0], errors.group[2]);
  EXPECT_TRUE(AboutGroups(errors, errors.value_rad).isApprox(Eigen::Vector4d(-1.0, 1.0, -2.0, 2.0)));
  EXPECT_TRUE(std::isnan(errors.u_reading_rad));  // nothing was read twice
}

TEST(MeansByPlace, StatesTheNoiseOfOneReading) {
  test::Noise normal(0.3 * arcsec, 5);
  std::vector<IndexReading> readings;
  for (int k = 0; k < 2000; ++k) readings.push_back({k % 2, (k / 4 % 100) * deg, 1e-5 * (k % 2) + normal()});
  // 2000 readings less 100 places and one constant: 1.6 % of one standard deviation.
  EXPECT_NEAR(MeansByPlace(readings).u_reading_rad, 0.3 * arcsec, 0.016 * 3.0 * 0.3 * arcsec);
}

}  // namespace
}  // namespace twinbench::separate
