#include "twin/uncertainty/monte_carlo.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/uncertainty/stated.h"

namespace twinbench::uncertainty {
namespace {

using test::FourInputs, test::Input, test::InputKeys;

std::vector<Quantity> Sum(const Scenario& s) {
  double sum = 0.0;
  for (std::size_t k = 0; k < InputKeys().size(); ++k) sum += 1e6 * Input(s, k);
  return {{"sum", sum, 0.0}};
}

Scenario FourOf(Distribution distribution, double u = 1e-6) {
  std::vector<StatedUncertainty> stated;
  for (const std::string& key : InputKeys()) stated.push_back({key, u, distribution});
  return FourInputs(stated);
}

/// JCGM 101, 9.2.3: the sum of four rectangular distributions of u = 1 has u = 2 and [-3.88, 3.88].
TEST(MonteCarlo, OfFourRectanglesIsThatOfTheSupplement) {
  const Spread spread = Propagate(FourOf(Distribution::kUniform), Sum, test::Trials(8000)).spreads.at(0);
  EXPECT_NEAR(spread.sd, 2.0, 0.05);
  EXPECT_NEAR(spread.symmetric[0], -3.88, 0.2);
  EXPECT_NEAR(spread.symmetric[1], 3.88, 0.2);
  EXPECT_NEAR(spread.shortest[1] - spread.shortest[0], 2.0 * 3.88, 0.25);
}

TEST(MonteCarlo, StopsWhenTwoDigitsStand) {
  const MonteCarlo result = Propagate(FourOf(Distribution::kNormal), Sum, {});
  EXPECT_TRUE(result.settled);
  EXPECT_LT(result.trials, 20000);
  EXPECT_NEAR(result.spreads.at(0).sd, 2.0, 0.06);
  MonteCarloOptions few;
  few.most_trials = 1000;
  EXPECT_FALSE(Propagate(FourOf(Distribution::kNormal), Sum, few).settled) << "and says when they do not";
}

TEST(MonteCarlo, IsTheSameToTheBitOnAnyNumberOfThreads) {
  MonteCarloOptions one, four;
  one.most_trials = four.most_trials = 2000;
  four.threads = 4;
  const MonteCarlo a = Propagate(FourOf(Distribution::kTriangular), Sum, one),
                   b = Propagate(FourOf(Distribution::kTriangular), Sum, four);
  ASSERT_EQ(a.trials, b.trials);
  EXPECT_EQ(a.spreads.at(0).sd, b.spreads.at(0).sd);
  EXPECT_EQ(a.spreads.at(0).shortest, b.spreads.at(0).shortest);
}

}  // namespace
}  // namespace twinbench::uncertainty
