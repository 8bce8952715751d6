#include <Eigen/Dense>
#include <numbers>

#include "twin/plan/optimal_programme.h"
#include "twin/plan/shift_sets.h"

namespace twinbench::plan {
namespace {

/// Variance of harmonic k of one table by least squares over all readings of all set-ups: both tables' cosine and
/// sine of that order as unknowns, unit noise; in units of 2 / (n m), what the mean of m set-ups would leave.
double ByLeastSquares(int n, const std::vector<int>& shifts, int k) {
  const auto m = static_cast<Eigen::Index>(shifts.size());
  Eigen::MatrixXd design(n * m, 4);
  for (Eigen::Index j = 0; j < m; ++j) {
    for (int i = 0; i < n; ++i) {
      const double a = 2.0 * std::numbers::pi * k * i / n;
      const double b = 2.0 * std::numbers::pi * k * (i + shifts[static_cast<std::size_t>(j)]) / n;
      design.row(j * n + i) << std::cos(a), std::sin(a), std::cos(b), std::sin(b);
    }
  }
  const Eigen::MatrixXd cov = (design.transpose() * design).inverse();
  return cov(0, 0) / (2.0 / (n * static_cast<double>(m)));
}

TEST(ShiftSets, VarianceIsThatOfLeastSquares) {
  for (const std::vector<int>& shifts : {std::vector<int>{0, 1}, {0, 1, 5}, {0, 3, 4, 11}}) {
    const std::vector<double> factors = VarianceFactors(24, shifts);
    for (const int k : {1, 2, 5, 7}) {
      const double expected = ByLeastSquares(24, shifts, k);
      EXPECT_NEAR(factors.at(static_cast<std::size_t>(k - 1)), expected, 1e-9 * expected) << k;
    }
  }
}

TEST(ShiftSets, ALostHarmonicIsOneThatEveryShiftTurnsByWholeTurns) {
  EXPECT_EQ(Judged(12, {0, 4}).lost, (std::vector<int>{3, 6}));
  EXPECT_TRUE(std::isinf(Judged(12, {0, 4}).mean_factor));
  EXPECT_TRUE(Judged(12, {0, 1}).lost.empty());
}

TEST(ShiftSets, TwoNeighboursAtManyPositionsLoseNothing) {
  // 1 / sin^2(pi k / n): at n = 10^6 the first order has 1e11 times the noise, and is not lost.
  for (const int n : {100000, 1000000}) {
    const std::vector<double> factors = VarianceFactors(n, {0, 1});
    for (const int k : {1, 2, n / 3, n / 2}) {
      const double expected = 1.0 / std::pow(std::sin(std::numbers::pi * k / n), 2);
      EXPECT_NEAR(factors.at(static_cast<std::size_t>(k - 1)) / expected, 1.0, 1e-10) << n << ' ' << k;
    }
    EXPECT_TRUE(Judged(n, {0, 1}).lost.empty());
    // The sum over all n - 1 orders of 1 / sin^2(pi k / n) is (n^2 - 1) / 3; n / 2 is counted once.
    EXPECT_NEAR(Judged(n, {0, 1}).mean_factor / (((n * 1.0 * n - 1.0) / 3.0 + 1.0) / n), 1.0, 1e-9);
  }
}

TEST(ShiftSets, TheBestOfASmallCircleIsTheBestOfAll) {
  const ShiftSet best = BestShifts(12, 3);
  EXPECT_TRUE(best.exhaustive);
  for (int a = 1; a < 12; ++a) {
    for (int b = a + 1; b < 12; ++b) EXPECT_GE(Judged(12, {0, a, b}).mean_factor, best.mean_factor - 1e-12);
  }
}

TEST(ShiftSets, NoSetIsBelowWhatParsevalLeaves) {
  // {0, 1, 3} is a cyclic difference set of 7: all orders alike, and the bound is reached.
  EXPECT_NEAR(Judged(7, {0, 1, 3}).mean_factor, LeastPossible(7, 3), 1e-9);
  for (const int n : {11, 12}) {
    for (const int m : {2, 3, 4}) EXPECT_GE(BestShifts(n, m).mean_factor, LeastPossible(n, m) - 1e-9) << n << " " << m;
  }
}

TEST(ShiftSets, OneMoreShiftIsTheBestThereIsAlsoWhereOrdersAreNearlyLost) {
  const ShiftSet more = WithOneMore(12, {0, 1}), of_many = WithOneMore(1000, {0, 1});
  EXPECT_TRUE(of_many.lost.empty());
  for (const int s : {2, 31, 367, 500, 999})
    EXPECT_GE(Judged(1000, {0, 1, s}).mean_factor, of_many.mean_factor * (1 - 1e-12));
  for (int s = 2; s < 12; ++s) EXPECT_GE(Judged(12, {0, 1, s}).mean_factor, more.mean_factor - 1e-12);
}

TEST(ShiftSets, FourGoodShiftsBeatTwoThatAreRepeated) {
  // Two shifts, each taken twice: the same factors as once, of the mean of four set-ups.
  for (const auto& [positions, by] : {std::pair{36, 2.9}, {360, 8.0}}) {
    const double repeated = Judged(positions, {0, 1, 0, 1}).mean_factor;
    EXPECT_GT(std::sqrt(repeated / BestShifts(positions, 4).mean_factor), by) << positions;
  }
}

TEST(ShiftSets, OfAFineCircleIsFoundByExchangesAndNearWhatNoneCanBeat) {
  const ShiftSet best = BestShifts(360, 5);
  EXPECT_FALSE(best.exhaustive);
  EXPECT_TRUE(best.lost.empty());
  EXPECT_GE(best.mean_factor, 1.0);
  EXPECT_LT(best.mean_factor, 1.5);
}

/// A reading of c0 + c1 x + c2 x^2 at x, unit noise.
RunInformation ReadingAt(double x, double cost = 1.0) {
  const Eigen::Vector3d f(1.0, x, x * x);
  return {cost, f * f.transpose()};
}

std::vector<RunInformation> ReadingsOnAGrid() {
  std::vector<RunInformation> readings;
  for (int k = -10; k <= 10; ++k) readings.push_back(ReadingAt(0.1 * k));
  return readings;
}

const Eigen::Matrix3d kNextToNothing = 1e-9 * Eigen::Matrix3d::Identity();

/// Equal weights at -1, 0, 1, where tr(M^-1 M_j) is p = 3 and nowhere more (Kiefer & Wolfowitz' own example).
TEST(BestMixture, OfAParabolaIsTheDOptimalOneOfTheLiterature) {
  const RelaxedProgramme best = BestMixture(kNextToNothing, ReadingsOnAGrid(), 1.0, Optimality::kD);
  for (const int at : {0, 10, 20}) EXPECT_NEAR(best.weights[at], 1.0 / 3.0, 1e-3);
  EXPECT_NEAR(best.criterion, std::log(4.0 / 27.0), 1e-4);
  EXPECT_GT(best.efficiency, 1.0 - 2e-5);
  Eigen::MatrixXd information = kNextToNothing;
  for (int k = 0; k < 21; ++k) information += best.weights[k] * ReadingsOnAGrid()[static_cast<std::size_t>(k)].information;
  EXPECT_NEAR(Derivatives(information, ReadingsOnAGrid(), Optimality::kD).maxCoeff(), 3.0, 3e-3);
}

/// Weights 1/4, 1/2, 1/4 at -1, 0, 1; the trace is 8.
TEST(BestMixture, OfAParabolaIsTheAOptimalOneOfTheLiteratureAndCountsPerCost) {
  const RelaxedProgramme best = BestMixture(kNextToNothing, ReadingsOnAGrid(), 1.0, Optimality::kA);
  EXPECT_NEAR(best.weights[0], 0.25, 2e-3);
  EXPECT_NEAR(best.weights[10], 0.50, 2e-3);
  EXPECT_NEAR(best.criterion, 8.0, 1e-3);
  EXPECT_LE(best.bound, best.criterion);
  // Twice as dear and twice as telling is the same.
  std::vector<RunInformation> runs = {ReadingAt(-1.0), ReadingAt(0.0), ReadingAt(1.0)};
  const double plain = BestMixture(kNextToNothing, runs, 1.0, Optimality::kD).criterion;
  runs[1].cost *= 2.0;
  runs[1].information *= 2.0;
  EXPECT_NEAR(BestMixture(kNextToNothing, runs, 1.0, Optimality::kD).criterion, plain, 1e-4);
}

/// What its certificate says of a programme is never better than what looking at all programmes says.
TEST(BestProgramme, IsWithinItsCertificateWhetherAllAreLookedAtOrSomeExchanged) {
  std::vector<RunInformation> runs = {ReadingAt(-1.0, 2.0), ReadingAt(-0.4, 1.0), ReadingAt(0.1, 1.5),
                                      ReadingAt(0.6, 1.0), ReadingAt(1.0, 2.5)};
  const Eigen::MatrixXd known = 0.1 * Eigen::MatrixXd::Identity(3, 3);
  for (const Optimality by : {Optimality::kD, Optimality::kA}) {
    const Programme all = BestProgramme(known, runs, 12.0, by);
    EXPECT_TRUE(all.exhaustive);
    EXPECT_LE(all.cost, 12.0 + 1e-6);
    EXPECT_GT(all.efficiency, 0.9);
    EXPECT_LE(all.efficiency, 1.0);
    std::vector<RunInformation> many = runs;  // with runs that tell nothing there are too many to look at
    for (int k = 0; k < 12; ++k) many.push_back({1.0, Eigen::MatrixXd::Zero(3, 3)});
    const Programme exchanged = BestProgramme(known, many, 12.0, by);
    EXPECT_FALSE(exchanged.exhaustive);
    // Within what its certificate says, and that is close.
    EXPECT_GT(exchanged.efficiency, 0.9);
    const double share = by == Optimality::kD ? std::exp((exchanged.criterion - all.criterion) / 3.0)
                                              : all.criterion / exchanged.criterion;
    EXPECT_LE(share, 1.0 + 1e-9);
    EXPECT_GE(share, exchanged.efficiency);
  }
}

}  // namespace
}  // namespace twinbench::plan
