#include "twin/separate/compensation.h"

#include <gmock/gmock.h>

#include "tests/core/input_error.h"
#include "tests/separate/index_spectrum.h"
#include "tests/support/kept_text.h"
#include "tests/support/night.h"

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
  std::mt19937_64 random(1);
  SpectrumBench bench = BenchWith({{1, 7 * arcsec, 0.4}, {2, 3 * arcsec, 1.0}, {90, 1 * arcsec, 2.0}}, 0.0);
  const std::vector<ReadingPlan> plan = {EvenPositions(), Between(1)};
  const IndexErrors first = bench.Read(plan, random);
  const Compensation compensation = Compensate(first);
  EXPECT_THAT(compensation.Orders(LineFate::kCompensated), ElementsAre(1, 2, 90));
  EXPECT_EQ(compensation.table.position_rad.size(), 2160u);  // 22 entries a period of order 90, whole degrees
  bench.commanded = compensation.table;
  // Products of the error with its own slope (7 arcsec times 90 times 1 arcsec): some milliarcseconds.
  EXPECT_LT(RootMeanSquare(AboutGroups(first, bench.Read(plan, random).value_rad)), 5e-3 * arcsec);
}

TEST(Compensate, GoesOnFromACompensationThatWasAtWork) {
  std::mt19937_64 random(1);
  SpectrumBench bench = BenchWith({{1, 7 * arcsec, 0.4}}, 0.05 * arcsec);
  CompensationTable half;  // of the error
  for (int i = 0; i < 360; ++i) {
    half.position_rad.push_back(i * deg);
    half.correction_rad.push_back(-0.5 * ErrorOf(bench.lines, i * deg));
  }
  bench.commanded = half;
  const Compensation compensation = Compensate(bench.Read({EvenPositions()}, random));
  EXPECT_NEAR(compensation.table.At(1.0), -ErrorOf(bench.lines, 1.0), 0.02 * arcsec);
}

TEST(Compensate, RefusesWhatATableOfFewEntriesCannotFollow) {
  std::mt19937_64 random(1);
  const SpectrumBench bench = BenchWith({{1, 7 * arcsec, 0.4}, {90, 1 * arcsec, 2.0}}, 0.1 * arcsec);
  CompensationOptions options;
  options.points = 200;
  const Compensation compensation = Compensate(bench.Read({EvenPositions(), Between(1)}, random), options);
  EXPECT_THAT(compensation.Orders(LineFate::kCompensated), ElementsAre(1));
  EXPECT_THAT(compensation.Orders(LineFate::kTooFine), ElementsAre(90));
  EXPECT_EQ(compensation.table.position_rad.size(), 200u);
  options.points = 3;
  EXPECT_KEPT(MessageOf([&] { Compensate(bench.Read({EvenPositions()}, random), options); }));
}

TEST(Compensate, AddsNothingWhereNothingIs) {
  std::mt19937_64 random(7);
  const SpectrumBench bench = BenchWith({}, 0.3 * arcsec);
  const Compensation compensation = Compensate(bench.Read({EvenPositions()}, random));
  EXPECT_TRUE(compensation.lines.empty());
  for (const double correction_rad : compensation.table.correction_rad) EXPECT_EQ(correction_rad, 0.0);
}

TEST(CheckCompensation, RefusesARunWithAnotherTable) {
  std::mt19937_64 random(1);
  const SpectrumBench bench = BenchWith({{1, 7 * arcsec, 0.4}}, 0.1 * arcsec);
  const IndexErrors first = bench.Read({EvenPositions()}, random);
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
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    SpectrumBench bench = DrawBench(random, 5);
    const IndexErrors first = bench.Read(plans, random);
    const IndexErrors check_before = bench.Read(checks, random);
    const Compensation compensation = Compensate(first);
    bench.commanded = compensation.table;
    const CompensationCheck check = CheckCompensation(first, compensation, bench.Read(plans, random));
    const IndexErrors check_after = bench.Read(checks, random);
    EXPECT_NEAR(check.Ratio(), 1.0, 0.2) << seed;
    EXPECT_TRUE(check.IsBetter()) << seed;
    EXPECT_LE(RootMeanSquare(AboutGroups(check_after, check_after.value_rad)),
              RootMeanSquare(AboutGroups(check_before, check_before.value_rad)))
        << seed;
    const auto is_above = [&](const SpectrumLine& line) { return line.order >= highest_told; };
    EXPECT_TRUE(compensation.IsAliased() || std::ranges::none_of(bench.lines, is_above)) << seed;
    for (const int order : compensation.Orders(LineFate::kCompensated)) {
      const auto is_it = [order](const SpectrumLine& line) { return line.order == order; };
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
  constexpr int kSeeds = 60, kLines = 12;  // a sixth of the places, the most that are looked for
  double mean_ratio = 0.0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    SpectrumBench bench = BenchWith({}, 2.0 * arcsec);
    for (int order = 1; order <= kLines; ++order) bench.lines.push_back({order, 100.0 / order * arcsec, 0.7 * order});
    const IndexErrors first = bench.Read({EvenPositions()}, random);
    const Compensation compensation = Compensate(first, options);
    EXPECT_EQ(compensation.Orders(LineFate::kCompensated).size(), static_cast<std::size_t>(kLines)) << seed;
    bench.commanded = compensation.table;
    mean_ratio += CheckCompensation(first, compensation, bench.Read({EvenPositions()}, random)).Ratio() / kSeeds;
  }
  EXPECT_NEAR(mean_ratio, 1.0, 0.04);  // 0.86 without it
}

}  // namespace
}  // namespace twinbench::separate
