#include "tests/separate/turntable_run.h"
#include "tests/support/over_seeds.h"
#include "twin/benches/turntable_autocollimator/estimators/equation_5.h"
#include "twin/benches/turntable_autocollimator/estimators/roll.h"
#include "twin/core/errors.h"

namespace twinbench::separate::turntable {
namespace {

constexpr int kRuns = 200;

TEST(EstimateRoll, IsTheSlopeOfTheDifferencesOfTwoTilts) {
  const auto stops = ReadPublished(2, 0.5 * arcsec).stops;
  double sx = 0.0, sy = 0.0, sxy = 0.0, syy = 0.0;
  for (std::size_t i = 0; i < 72; ++i) {
    const double dx = stops[i + 72].x_rad - stops[i].x_rad, dy = stops[i + 72].y_rad - stops[i].y_rad;
    sx += dx, sy += dy, sxy += dx * dy, syy += dy * dy;
  }
  const double slope = (sxy - sx * sy / 72) / (syy - sy * sy / 72);
  const Roll roll = EstimateRoll(stops, Stated(0.5 * arcsec));
  EXPECT_EQ(roll.status, RollStatus::kOk);
  EXPECT_NEAR(std::tan(roll.gamma_rad) * roll.attenuation, slope, 1e-12);  // rounding
  EXPECT_NEAR(1.0 - roll.attenuation, 71 * 2 * 0.25 * arcsec * arcsec / (syy - sy * sy / 72), 1e-12);
  const double u = std::hypot(0.5 * arcsec, 0.0105 * 0.5 * arcsec) * std::sqrt(2.0 / (syy - sy * sy / 72));
  EXPECT_NEAR(roll.u_gamma_rad / u, 1.0, 0.001);  // closed form of a straight line; attenuation 1e-4
}

/// Mean squared error over variance of `runs` estimates.
double MeanSquaredPull(double u_rad, const std::vector<Seat>& seats, int n, bool stated) {
  return test::MeanOverSeeds(kRuns, [&](std::uint64_t seed) {
    const auto stops = ReadPublished(seed, u_rad, seats, n, stated ? 1 : 2).stops;
    const Roll roll = EstimateRoll(stops, stated ? Stated(u_rad) : AutocollimatorNoise{});
    EXPECT_EQ(roll.status, RollStatus::kOk);
    return std::pow((roll.gamma_rad - 0.6 * deg) / roll.u_gamma_rad, 2);
  });
}

TEST(EstimateRoll, StatesAnUncertaintyThatMatchesItsScatter) {
  // chi2 with 1 degree of freedom a run: mean 1, standard deviation sqrt(2 / 200) = 0.1.
  EXPECT_NEAR(MeanSquaredPull(0.5 * arcsec, TwoTilts(), 72, true), 1.0, 0.3);
  EXPECT_NEAR(MeanSquaredPull(0.2 * arcsec, TwoTilts(), 12, true), 1.0, 0.3);
  EXPECT_NEAR(MeanSquaredPull(0.5 * arcsec, TwoTilts(), 72, false), 1.0, 0.3);  // noise from repeats
  const std::vector<Seat> three_shifts = {{0, 60 * arcsec, 0.4}, {30, 100 * arcsec, 2.1}, {210, 80 * arcsec, 4.0}};
  EXPECT_NEAR(MeanSquaredPull(0.5 * arcsec, three_shifts, 72, true), 1.0, 0.3);
}

TEST(EstimateRoll, IsNotPulledToZeroByTheNoiseOfY) {
  // A change of tilt of 2.5 arcsec against 0.5 arcsec of noise: the plain slope would lose 2 * 0.25 against
  // 0.5 * 2.5^2, 14 % or 0.05.
  const double mean = test::MeanOverSeeds(kRuns, [](std::uint64_t seed) {
    Stream stream(seed, "test.turntable");
    TrueBench bench = PublishedBench(0.5 * arcsec, stream);
    bench.gamma_rad = 20.0 * deg;
    const auto stops = ReadCircles(bench, {{0, 10 * arcsec, 0.4}, {0, 12.5 * arcsec, 0.4}}, 72, stream);
    return std::tan(EstimateRoll(stops, Stated(0.5 * arcsec)).gamma_rad);
  });
  // One run scatters by about 0.5 sqrt(2) / sqrt(36 * 2.5^2) = 0.05, their mean by 0.004.
  EXPECT_NEAR(mean, std::tan(20.0 * deg), 0.012);
}

TEST(EstimateRoll, SaysWhenTheTiltsAreTooMuchAlikeAndNeedsAThirdSetUpIfTheShiftsDiffer) {
  const Seat one{0, 60 * arcsec, 0.4};
  const auto status_of = [](const std::vector<Seat>& seats, int passes, const AutocollimatorNoise& noise) {
    return EstimateRoll(ReadPublished(3, 0.5 * arcsec, seats, 72, passes).stops, noise).status;
  };
  EXPECT_EQ(status_of({one, one}, 1, Stated(0.5 * arcsec)), RollStatus::kTiltsAlike);
  EXPECT_EQ(status_of({one, one}, 1, {}), RollStatus::kTiltsAlike);  // noise not known
  for (const int passes : {1, 4}) EXPECT_EQ(status_of({one}, passes, {}), RollStatus::kTiltsHidden);
  // Two shifts: a tilt that turns once with each table is order 1 of turntable and multi-tooth table.
  const auto stops = ReadPublished(4, 0.5 * arcsec, {{0, 60 * arcsec, 0.4}, {5, 100 * arcsec, 2.1}}).stops;
  EXPECT_EQ(EstimateRoll(stops, Stated(0.5 * arcsec)).status, RollStatus::kTiltsHidden);
  EXPECT_TRUE(std::isnan(EstimateRoll(stops).gamma_rad));
}

TEST(EstimateRoll, IsNoneWhereWhatIsLeftOverShowsNoTilt) {
  // Six positions, two steps between the shifts: order 3 of the set-ups is left over, and a tilt is order 1.
  for (const double other_tilt : {60 * arcsec, 100 * arcsec}) {
    const auto stops = ReadPublished(3, 0.5 * arcsec, {{0, 60 * arcsec, 0.4}, {120, other_tilt, 2.1}}, 6).stops;
    EXPECT_EQ(EstimateRoll(stops).status, RollStatus::kTiltsHidden);
    EXPECT_EQ(EstimateRoll(stops, Stated(0.001 * arcsec)).status, RollStatus::kTiltsHidden);
  }
}

TEST(EstimateRoll, IsNoneWhereASingleReadingIsLeftOverAndNobodyStatesTheNoise) {
  auto stops = ReadPublished(3, 0.5 * arcsec, {{0, 60 * arcsec, 0.4}, {0, 100 * arcsec, 2.1}}, 3).stops;
  stops.back().x_rad = kNaN;
  EXPECT_EQ(EstimateRoll(stops).status, RollStatus::kNoiseNotKnown);
  EXPECT_EQ(EstimateRoll(stops, Stated(0.5 * arcsec)).status, RollStatus::kOk);
}

TEST(EstimateRoll, IsHardlyEverTakenFromTheNoiseOfAFewReadings) {
  const auto found_of = [](double other_tilt_rad, double other_azimuth_rad, int n) {
    const std::vector<Seat> seats = {{0, 60 * arcsec, 0.4}, {0, other_tilt_rad, other_azimuth_rad}};
    return test::CountOverSeeds(kRuns, [&](std::uint64_t seed) {
      return EstimateRoll(ReadPublished(seed, 0.5 * arcsec, seats, n).stops).status == RollStatus::kOk;
    });
  };
  // p < 0.001 of F, and the noise is taken across the line that fits best, which makes it some times smaller.
  for (const int n : {4, 6, 12}) EXPECT_LE(found_of(60 * arcsec, 0.4, n), 3) << n;
  for (const int n : {6, 12}) EXPECT_EQ(found_of(100 * arcsec, 2.1, n), kRuns) << n;
}

std::vector<PointwiseError> SolvedOfTwoTilts(const std::vector<TurntableStop>& stops, double u_rad = 0.2 * arcsec) {
  return SolveEquation5(stops, 0, 1, Stated(u_rad));
}

TEST(SolveEquation5, IsExactAwayFromItsPolesWithoutNoise) {
  const auto [bench, stops] = ReadPublished(5, 0.0);
  const auto points = SolvedOfTwoTilts(stops, 0.0);
  ASSERT_EQ(points.size(), 72u);
  EXPECT_EQ(points[0].value_rad, 0.0);
  for (int i = 1; i < 72; ++i) {
    const double truth = bench.Index(5.0 * i, 0.0) - bench.Index(0.0, 0.0);
    // cos g = 1 is assumed: 5.5e-5 of up to 17.82 arcsec.
    EXPECT_NEAR(points[static_cast<std::size_t>(i)].value_rad, truth, 0.001 * arcsec) << i;
  }
}

TEST(SolveEquation5, StatesWhatItLeavesOutOfALargeRoll) {
  TrueBench bench = ReadPublished(5, 0.0).bench;
  Stream noise(1, "none");
  for (const double gamma_rad : {0.3, -1.0}) {
    bench.gamma_rad = gamma_rad;
    const auto points = SolvedOfTwoTilts(ReadCircles(bench, {{0, 60 * arcsec, 0.4}, {0, 100 * arcsec, 2.1}}, 72, noise), 0.0);
    for (std::size_t i = 1; i < points.size(); ++i) {
      const double truth = bench.Index(5.0 * static_cast<double>(i), 0.0) - bench.Index(0.0, 0.0);
      EXPECT_NEAR(points[i].u_rad, std::abs(points[i].value_rad - truth), 1e-6 * arcsec) << gamma_rad << " " << i;
    }
  }
}

/// y of two tilts b cos(phi - a), each from its start: their difference is A (cos(phi - f) - cos f), zero at 0 and
/// 2 f.
TEST(SolveEquation5, SaysWhereItsPolesAre) {
  const auto points = SolvedOfTwoTilts(ReadPublished(6, 0.2 * arcsec).stops);
  const double f = std::atan2(100 * std::sin(2.1) - 60 * std::sin(0.4), 100 * std::cos(2.1) - 60 * std::cos(0.4));
  const auto nearest = static_cast<std::size_t>(std::lround(2.0 * f / (5.0 * deg)) + 72) % 72;
  EXPECT_EQ(points[nearest].status, PointStatus::kNearPole);
  EXPECT_EQ(points[36].status, PointStatus::kOk);
  EXPECT_GT(points[nearest].u_rad, 5.0 * points[36].u_rad);
}

TEST(SolveEquation5, CallsEveryPositionAPoleIfTheTiltsAreAlike) {
  const auto is_ok = [](const PointwiseError& point) { return point.status == PointStatus::kOk; };
  for (const double tilt_rad : {0.0, 60 * arcsec}) {
    const Seat seat{0, tilt_rad, 0.4};
    const auto points = SolvedOfTwoTilts(ReadPublished(8, 0.2 * arcsec, {seat, seat}).stops);
    // A difference exceeds 3 standard uncertainties in 0.3 % of the cases; the start's noise is common.
    EXPECT_LE(std::count_if(points.begin(), points.end(), is_ok), 3);
  }
}

TEST(SolveEquation5, LeavesOutPositionsThatOneSetUpDidNotRead) {
  auto stops = ReadPublished(9, 0.2 * arcsec).stops;
  stops[0].x_rad = stops[100].y_rad = kNaN;
  const auto points = SolvedOfTwoTilts(stops);
  EXPECT_EQ(points[0].status, PointStatus::kMissing);
  EXPECT_EQ(points[28].status, PointStatus::kMissing);
  EXPECT_TRUE(std::isnan(points[28].value_rad));
  EXPECT_EQ(points[1].value_rad, 0.0);  // the start now
  EXPECT_EQ(points[36].status, PointStatus::kOk);
}

TEST(SolveEquation5, StatesAnUncertaintyThatMatchesItsScatterAwayFromPoles) {
  double sum = 0.0;
  int count = 0;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    const auto [bench, stops] = ReadPublished(seed, 0.2 * arcsec);
    for (const PointwiseError& point : SolvedOfTwoTilts(stops)) {
      if (point.status != PointStatus::kOk || point.u_rad == 0.0) continue;
      const double truth = bench.Index(point.turntable_rad / deg, 0.0) - bench.Index(0.0, 0.0);
      sum += std::pow((point.value_rad - truth) / point.u_rad, 2);
      ++count;
    }
  }
  // Points of a run share the start's noise: about 2 independent ones a run, sqrt(2 / 400) = 0.07.
  EXPECT_NEAR(sum / count, 1.0, 0.2);
}

TEST(SolveEquation5, RefusesSetUpsOfDifferentShift) {
  const auto stops = ReadIdeal({{0, 60 * arcsec, 0.4}, {5, 100 * arcsec, 2.1}}, 72);
  EXPECT_THROW(SolveEquation5(stops, 0, 1, Stated(0.2 * arcsec)), InputError);
  EXPECT_THROW(SolveEquation5(stops, 0, 8, Stated(0.2 * arcsec)), InputError);
}

}  // namespace
}  // namespace twinbench::separate::turntable
