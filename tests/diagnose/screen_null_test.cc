#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tests/diagnose/support/synthetic_run.h"
#include "twin/core/distributions.h"

namespace twinbench::diagnose {
namespace {

constexpr int kNullSeeds = 300;

/// Largest distance of the empirical distribution from the uniform one.
double Kolmogorov(std::vector<double> p) {
  std::sort(p.begin(), p.end());
  double distance = 0.0;
  const auto n = static_cast<double>(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    const auto below = static_cast<double>(i);
    distance = std::max({distance, std::abs(p[i] - below / n), std::abs(p[i] - (below + 1.0) / n)});
  }
  return distance;
}

/// The residual tests of many runs of normal noise; `scale` is the true noise over the stated one.
std::vector<std::vector<ResidualTest>> OfNoise(const LinearRun& clean, int seeds, double scale) {
  std::vector<std::vector<ResidualTest>> all;
  for (int seed = 0; seed < seeds; ++seed) {
    LinearRun run = clean;
    AddNoise(run, static_cast<std::uint64_t>(seed));
    run.residual *= scale;
    // Nulls of their own for every run: shared ones would make the p-values depend on each other.
    all.push_back(TestsAsStated(run, 99, 1000 + static_cast<std::uint64_t>(seed)));
  }
  return all;
}

std::map<std::string, std::vector<double>> PValuesOf(const std::vector<std::vector<ResidualTest>>& all) {
  std::map<std::string, std::vector<double>> p;
  for (const auto& tests : all) {
    for (const ResidualTest& t : tests) p[t.name].push_back(t.p);
  }
  return p;
}

void ExpectHonest(const LinearRun& clean) {
  const auto all = OfNoise(clean, kNullSeeds, 1.0);
  for (const auto& [name, values] : PValuesOf(all)) {
    ASSERT_EQ(values.size(), static_cast<std::size_t>(kNullSeeds)) << name;
    // Kolmogorov: sqrt(n) D exceeds 1.95 with probability 0.001. Steps of 1 / 100 in p add at most 0.01.
    EXPECT_LT(Kolmogorov(values), 1.95 / std::sqrt(kNullSeeds) + 0.01) << name;
  }
  const auto alarms = std::ranges::count_if(all, [](const std::vector<ResidualTest>& tests) {
    return std::ranges::any_of(
        tests, [&](const ResidualTest& t) { return t.p < 0.1 / static_cast<double>(tests.size()); });
  });
  // A tenth shared by five tests: 29 of 300 if they are independent, standard deviation 5; 14 and 45 have 0.001.
  EXPECT_GT(alarms, 13);
  EXPECT_LT(alarms, 46);
}

TEST(ResidualTests, HoldTheirPValuesWhereTablesAreFree) {
  const LinearRun clean = SyntheticRun({.positions = 8, .shifts = {0, 1, 3}, .passes = {1, -1, -1, 1}});
  EXPECT_EQ(TestsAsStated(clean, 50, 1).size(), 5u);
  ExpectHonest(clean);
}

TEST(ResidualTests, HoldTheirPValuesInALongSweep) {
  ExpectHonest(SyntheticSweep(240));
}

TEST(ResidualTests, BlameAWrongNoiseFigureOnTheNoiseAndNotOnStructure) {
  constexpr int kFew = 40;
  const LinearRun clean = SyntheticRun({.positions = 8, .shifts = {0, 1, 3}, .passes = {1, -1, -1, 1}});
  for (const auto& [name, values] : PValuesOf(OfNoise(clean, kFew, 1.25))) {
    const auto low = std::count_if(values.begin(), values.end(), [](double v) { return v < 0.01; });
    // 384 rows tell the level to 4 %; the other tests are below 0.01 in 0.4 of 40 runs: 5 has probability 1e-4.
    if (name == "fit to stated noise")
      EXPECT_EQ(low, kFew);
    else
      EXPECT_LT(low, 5) << name;
  }
}

TEST(FitToStatedNoise, HasThePValueOfTheChiSquaredDistribution) {
  const LinearRun clean = SyntheticSweep(400);  // one free constant: 399 degrees of freedom
  for (const auto& tests : OfNoise(clean, 10, 1.0)) {
    const ResidualTest fit = *Find(tests, "fit to stated noise");
    const double above = ChiSquaredExceedance(fit.statistic, 399.0);
    // 99 simulated runs tell a p near 0.5 to 0.05, and it is two-sided by deviations of the logarithm.
    EXPECT_NEAR(fit.p, 2.0 * std::min(above, 1.0 - above), 0.16);
  }
}

}  // namespace
}  // namespace twinbench::diagnose
