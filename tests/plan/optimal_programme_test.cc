#include "twin/plan/optimal_programme.h"

#include <gtest/gtest.h>

#include <cmath>

namespace twinbench::plan {
namespace {

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
TEST(BestMixture, OfAParabolaIsTheAOptimalOneOfTheLiterature) {
  const RelaxedProgramme best = BestMixture(kNextToNothing, ReadingsOnAGrid(), 1.0, Optimality::kA);
  EXPECT_NEAR(best.weights[0], 0.25, 2e-3);
  EXPECT_NEAR(best.weights[10], 0.50, 2e-3);
  EXPECT_NEAR(best.criterion, 8.0, 1e-3);
  EXPECT_LE(best.bound, best.criterion);
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

/// Twice as dear and twice as telling is the same.
TEST(BestMixture, CountsPerCost) {
  std::vector<RunInformation> runs = {ReadingAt(-1.0), ReadingAt(0.0), ReadingAt(1.0)};
  const double plain = BestMixture(kNextToNothing, runs, 1.0, Optimality::kD).criterion;
  runs[1].cost *= 2.0;
  runs[1].information *= 2.0;
  EXPECT_NEAR(BestMixture(kNextToNothing, runs, 1.0, Optimality::kD).criterion, plain, 1e-4);
}

}  // namespace
}  // namespace twinbench::plan
