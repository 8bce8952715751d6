#include <utility>

#include "tests/separate/shift_formulas.h"
#include "tests/separate/turntable_run.h"
#include "tests/support/kept_text.h"
#include "twin/core/errors.h"

namespace twinbench::separate::turntable {
namespace {

using testing::ElementsAre, testing::HasSubstr;

const std::vector<int> kFourOf36 = {0, 1, 7, 11}, kFourOf72 = {0, 3, 5, 19};

/// Seats at these shifts [steps of 360 deg / n], tilts of 60, 80, 100 ... arcsec in several directions.
std::vector<Seat> Seats(int n, const std::vector<int>& shifts) {
  std::vector<Seat> seats;
  for (const int shift : shifts) {
    const auto k = static_cast<double>(seats.size());
    seats.push_back({shift * 360.0 / n, (60.0 + 20.0 * k) * arcsec, 0.4 + 1.7 * k});
  }
  return seats;
}

IndexingOptions NoiseOf(double u_rad) {
  return IndexingOptions{.noise = Stated(u_rad)};
}

IndexingOptions Options(double u_rad, double gamma_rad = 0.0) {
  IndexingOptions options = NoiseOf(u_rad);
  options.roll = Roll{RollStatus::kGiven, gamma_rad, 0.0};
  return options;
}

Eigen::VectorXd WithoutMean(const Eigen::VectorXd& values) { return values.array() - values.mean(); }

Eigen::VectorXd TrueTurntable(const TrueBench& bench, int n) {
  Eigen::VectorXd truth(n);
  for (int i = 0; i < n; ++i) truth[i] = bench.turntable.At(i * 360.0 / n * deg);
  return WithoutMean(truth);
}

Eigen::VectorXd TrueTeeth(const TrueBench& bench, const AngleSeries& series) {
  Eigen::VectorXd truth(std::ssize(series.position_rad));
  for (Eigen::Index i = 0; i < truth.size(); ++i)
    truth[i] = bench.Tooth(series.position_rad[static_cast<std::size_t>(i)] / deg);
  return WithoutMean(truth);
}

TEST(SeparateIndexing, FindsBothTablesExactlyWithoutNoise) {
  for (const int n : {36, 72}) {
    const auto [bench, stops] = ReadPublished(1, 0.0, Seats(n, kFourOf36), n);
    const auto found = SeparateIndexing(stops, NoiseOf(0.0));
    EXPECT_EQ(found.status, IndexingStatus::kSeparated);
    EXPECT_TRUE(found.lost_harmonics.empty());
    EXPECT_NEAR(found.roll.gamma_rad, 0.6 * deg, 1e-12);  // rounding, here and below
    EXPECT_LT((found.turntable.value_rad - TrueTurntable(bench, n)).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_LT((found.multitooth.value_rad - TrueTeeth(bench, found.multitooth)).cwiseAbs().maxCoeff(), 1e-14);
  }
}

double Gain(int n, const std::vector<int>& shifts) {
  const auto found = SeparateIndexing(ReadIdeal(Seats(n, shifts), n), Options(1e-6));
  const Eigen::MatrixXd cov = found.turntable.cov_rad2.ToDense();
  EXPECT_NEAR(found.multitooth.cov_rad2.diagonal().sum() / found.turntable.cov_rad2.diagonal().sum(), 1.0, 1e-9);
  for (int k = 1; k < n; ++k)
    EXPECT_NEAR(HarmonicVariance(cov, k) / 1e-12 / ShiftVariance(n, shifts, k), 1.0, 1e-9) << k;  // rounding
  return RootMeanGain(cov, 1e-6);
}

TEST(SeparateIndexing, PropagatesTheNoiseOfEveryHarmonicAsTheClosedFormAndTheShiftTablesSay) {
  for (const int n : {36, 72}) EXPECT_NEAR(Gain(n, {0, 1}), std::sqrt((n * n - 1.0) / (6 * n)), 1e-9);  // closed form
  const std::tuple<int, std::vector<int>, double> printed[] = {
      {36, {0, 1, 6}, 0.781}, {36, kFourOf36, 0.579}, {36, {0, 1, 9, 11, 15}, 0.491},  {36, {0, 1, 4, 10, 15, 17}, 0.436},
      {72, {0, 1, 9}, 0.840}, {72, kFourOf72, 0.599}, {72, {0, 1, 12, 17, 26}, 0.503}, {72, {0, 1, 4, 12, 25, 31}, 0.445}};
  for (const auto& [n, shifts, gain] : printed) EXPECT_NEAR(Gain(n, shifts), gain, 6e-4);  // three digits
}

/// Amplitude of order k in a series of n values.
double Amplitude(const Eigen::VectorXd& values, int k) {
  const auto n = static_cast<double>(values.size());
  const Eigen::ArrayXd phase = Eigen::ArrayXd::LinSpaced(values.size(), 0.0, units::turn * k * (n - 1.0) / n);
  const double cosine = (values.array() * phase.cos()).mean(), sine = (values.array() * phase.sin()).mean();
  return (2 * k == values.size() ? 1.0 : 2.0) * std::hypot(cosine, sine);
}

TEST(SeparateIndexing, CountsExactlyTheLostHarmonicsOfTheTeethAsTheTurntables) {
  for (const auto& shifts : std::vector<std::vector<int>>{{0, 18}, {0, 12, 24}, {0, 4, 10}, {2, 11}}) {
    for (int k = 1; k <= 18; ++k) {
      TrueBench bench;
      for (int j = 0; j < 360; ++j) bench.tooth_rad[static_cast<std::size_t>(j)] = 1e-6 * std::cos(k * j * deg);
      Stream stream(4, "test.turntable");
      const auto found = SeparateIndexing(ReadCircles(bench, Seats(36, shifts), 36, stream), Options(1e-6));
      EXPECT_EQ(found.status, IndexingStatus::kHarmonicsLost);
      const bool lost = testing::Value(found.lost_harmonics, testing::Contains(k));
      EXPECT_NEAR(Amplitude(found.turntable.value_rad, k), lost ? 1e-6 : 0.0, 1e-15) << k;
      EXPECT_NEAR(Amplitude(found.multitooth.value_rad, k), lost ? 0.0 : 1e-6, 1e-15) << k;
    }
  }
}

TEST(SeparateIndexing, ReturnsTheSumForOneShiftAndSaysSo) {
  const auto [bench, stops] = ReadPublished(5, 0.0);
  const auto found = SeparateIndexing(stops, NoiseOf(0.2 * arcsec));
  EXPECT_EQ(found.status, IndexingStatus::kSumOnly);
  EXPECT_EQ(found.lost_harmonics.size(), 36u);
  EXPECT_TRUE(found.multitooth.position_rad.empty());
  ASSERT_EQ(found.notes.size(), 1u);
  EXPECT_KEPT(found.notes[0]);
  Eigen::VectorXd sum(72);
  for (int i = 0; i < 72; ++i) sum[i] = bench.Index(5.0 * i, 0.0);
  // The noise stated is not there: 8e-6 of the roll is taken off, 3e-5 * 0.0105 of 100 arcsec.
  EXPECT_LT((found.turntable.value_rad - WithoutMean(sum)).cwiseAbs().maxCoeff(), 1e-4 * arcsec);
}

TEST(SeparateIndexing, AddsTheTeethToTheUncertaintyOfASum) {
  IndexingOptions options = Options(0.2 * arcsec);
  options.u_multitooth_rad = 0.3 * arcsec;
  const auto turntable_with = [&](const std::vector<int>& shifts) {
    return SeparateIndexing(ReadIdeal(Seats(72, shifts), 72), options).turntable;
  };
  // Both are independent from position to position, their mean is taken away.
  EXPECT_NEAR(turntable_with({0}).U_rad(5) / arcsec, std::sqrt((0.04 + 0.09) * 71 / 72), 1e-9);
  EXPECT_NEAR(turntable_with({0, 1, 9}).U_rad(5) / arcsec, 0.2 * 0.840, 2e-4);  // separated: no part of the teeth's
  const double order_2 = HarmonicVariance(turntable_with({0, 36}).cov_rad2.ToDense(), 2);
  EXPECT_NEAR(order_2 / (arcsec * arcsec), (0.04 / 2 + 0.09) / 72, 1e-9);  // mean of two readings, and the teeth
}

TEST(SeparateIndexing, AveragesOverTeethBetweenTheSteps) {
  Stream stream(7, "test.turntable");
  TrueBench bench = PublishedBench(0.0, stream);
  bench.gamma_rad = 0.0;
  IndexingOptions options = Options(0.0);
  options.u_multitooth_rad = 0.3 * arcsec;
  const std::vector<Seat> rows = {{0, 0, 0}, {6, 0, 0}, {12, 0, 0}};  // degrees on a grid of 5
  const auto found = SeparateIndexing(ReadCircles(bench, rows, 72, stream), options);
  EXPECT_EQ(found.status, IndexingStatus::kSumOnly);
  Eigen::VectorXd mean(72);
  for (int i = 0; i < 72; ++i)
    mean[i] = (bench.Index(5.0 * i, 0) + bench.Index(5.0 * i, 6) + bench.Index(5.0 * i, 12)) / 3.0;
  EXPECT_LT((found.turntable.value_rad - WithoutMean(mean)).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_NEAR(found.turntable.U_rad(0) / arcsec, 0.3 / std::sqrt(3.0) * std::sqrt(71.0 / 72), 1e-9);
}

TEST(SeparateIndexing, TakesTheNoiseFromRepeatsAndFromTheResidualsIfNothingWasReadTwice) {
  const auto found = SeparateIndexing(ReadPublished(8, 0.4 * arcsec).stops);
  EXPECT_EQ(found.noise.dof, 70);  // 144 readings, 71 + 2 constants + the roll
  EXPECT_NEAR(found.noise.u_x_rad, 0.4 * arcsec, 4 * 0.4 * arcsec / std::sqrt(2 * 70));
  EXPECT_TRUE(std::isnan(found.chi2));
  const auto twice = SeparateIndexing(ReadPublished(8, 0.2 * arcsec, TwoTilts(), 72, 2).stops);
  EXPECT_EQ(twice.noise.dof, 144);  // repeats of two passes
  EXPECT_NEAR(twice.noise.u_x_rad, 0.2 * arcsec, 5 * 0.2 * arcsec / std::sqrt(2 * 144));
}

TEST(SeparateIndexing, ScalesANoiseThatIsStatedTooSmall) {
  const auto found_with = [](double u_rad) {
    return SeparateIndexing(ReadPublished(9, 0.4 * arcsec, Seats(72, kFourOf72)).stops, NoiseOf(u_rad));
  };
  const auto found = found_with(0.2 * arcsec);
  // 4 * 72 readings less 71 + 71 values, 4 constants and the roll.
  EXPECT_NEAR(found.dof, 141.0, 1e-9);
  EXPECT_NEAR(found.scale, 2.0, 4 * 2.0 / std::sqrt(2 * 141));
  EXPECT_THAT(found.notes, ElementsAre(HasSubstr("scaled")));
  const auto right = found_with(0.2 * found.scale * arcsec);
  EXPECT_NEAR(found.turntable.U_rad(0) / right.turntable.U_rad(0), 1.0, 0.01);
  EXPECT_NEAR(found.roll.u_gamma_rad / right.roll.u_gamma_rad, 1.0, 0.01);
}

TEST(SeparateIndexing, BearsMissingStopsWhereTheOthersAreEnough) {
  auto [bench, four] = ReadPublished(10, 0.0, Seats(36, kFourOf36), 36);
  four[3].x_rad = four[80].y_rad = kNaN;
  const auto found = SeparateIndexing(four, Options(1e-6, 0.6 * deg));
  EXPECT_EQ(found.status, IndexingStatus::kSeparated);
  EXPECT_NEAR(found.dof, 142.0 - 35 - 35 - 4, 1e-9);
  EXPECT_TRUE(std::isnan(found.residual_rad[3]));
  EXPECT_LT((found.turntable.value_rad - TrueTurntable(bench, 36)).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(SeparateIndexing, SaysWhenMissingStopsLoseMoreThanTheShifts) {
  // Two shifts have one reading more than unknowns but for the constants: without any one stop a ramp is free.
  for (const int n : {12, 36}) {
    auto two = ReadIdeal(Seats(n, {0, 1}), n);
    IndexingOptions options = Options(1e-6);
    options.positions = n;
    EXPECT_EQ(SeparateIndexing(two, options).status, IndexingStatus::kSeparated);
    for (auto& stop : two) {
      const double x_rad = std::exchange(stop.x_rad, kNaN);
      const auto found = SeparateIndexing(two, options);
      EXPECT_EQ(found.status, IndexingStatus::kUndetermined);
      EXPECT_TRUE(found.turntable.value_rad.array().isNaN().all());
      EXPECT_THAT(found.notes, ElementsAre(HasSubstr("missing")));
      stop.x_rad = x_rad;
    }
  }
}

TEST(SeparateIndexing, LeavesOutPositionsThatWereNeverRead) {
  std::vector<TurntableStop> stops = ReadPublished(12, 0.0).stops;
  stops[10].x_rad = stops[82].x_rad = kNaN;
  const auto found = SeparateIndexing(stops, Options(1e-6, 0.6 * deg));
  ASSERT_EQ(found.turntable.position_rad.size(), 71u);
  EXPECT_NEAR(found.turntable.position_rad[10], 55.0 * deg, 1e-12);
  EXPECT_NEAR(found.turntable.value_rad.mean(), 0.0, 1e-15);
}

TEST(SeparateIndexing, TellsWhatAnUnknownRollCouldDo) {
  const auto found = SeparateIndexing(ReadIdeal({{0, 100 * arcsec, 0.4}}, 72));
  EXPECT_EQ(found.roll.status, RollStatus::kTiltsHidden);
  ASSERT_EQ(found.notes.size(), 2u);
  EXPECT_THAT(found.notes[1], HasSubstr("up to 1.74"));  // 100 arcsec * pi / 180 = 1.745, at most at a position
}

TEST(SeparateIndexing, CarriesTheUncertaintyOfAGivenRoll) {
  IndexingOptions options = Options(0.0);
  options.roll->u_gamma_rad = 0.1 * deg;
  const auto found = SeparateIndexing(ReadIdeal({{0, 100 * arcsec, 0.0}}, 72), options);
  for (const int i : {0, 5, 30}) {
    const double u_rad = 0.1 * deg * 100 * arcsec * std::abs(std::cos(5.0 * i * deg));
    EXPECT_NEAR(found.turntable.U_rad(i), u_rad, 1e-15);  // rounding
  }
}

TEST(SeparateIndexing, RefusesAnglesThatContradictEachOther) {
  const std::vector<TurntableStop> right = ReadIdeal(TwoTilts(), 36);
  const IndexingOptions of_36{.positions = 36};
  auto stops = right;
  for (const double tooth_rad : {right[40].multitooth_rad + 10 * deg, kNaN}) {
    stops[40].multitooth_rad = tooth_rad;
    EXPECT_THROW(SeparateIndexing(stops), InputError);
  }
  stops = right;
  stops[40].turntable_rad += 1 * deg;
  EXPECT_THROW(SeparateIndexing(stops, of_36), InputError);
  EXPECT_THROW(SeparateIndexing(stops), InputError);
  stops[40].setup = 7;  // a set-up of its own, off the grid
  EXPECT_THROW(SeparateIndexing(stops, of_36), InputError);
  EXPECT_THROW(SeparateIndexing({}), InputError);
}

}  // namespace
}  // namespace twinbench::separate::turntable
