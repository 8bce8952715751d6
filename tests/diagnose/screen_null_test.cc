#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tests/diagnose/support/synthetic_run.h"
#include "twin/diagnose/screen/significance.h"

namespace twinbench::diagnose {
namespace {

constexpr int kSeeds = 200;
constexpr int kNullRuns = 99;

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

/// p-values of every test over many runs of white noise; `scale` is the true noise over the stated one.
std::map<std::string, std::vector<double>> NullPValues(int seeds, double scale) {
  const LinearRun clean = SyntheticRun({.positions = 8, .shifts = {0, 1, 3}, .passes = {1, -1, -1, 1}});
  std::map<std::string, std::vector<double>> p;
  for (int seed = 0; seed < seeds; ++seed) {
    LinearRun run = clean;
    AddNoise(run, static_cast<std::uint64_t>(seed));
    run.residual *= scale;
    // Nulls of their own for every run: shared ones would make the 200 p-values depend on each other.
    for (const ScreenTest& t : ScreenAsStated(run, kNullRuns, 1000 + static_cast<std::uint64_t>(seed))) {
      p[t.name].push_back(t.p);
    }
  }
  return p;
}

TEST(Screen, GivesEveryTestAUniformPValueUnderWhiteNoise) {
  const auto p = NullPValues(kSeeds, 1.0);
  EXPECT_GE(p.size(), 25u);
  for (const auto& [name, values] : p) {
    ASSERT_EQ(values.size(), static_cast<std::size_t>(kSeeds)) << name;
    // Kolmogorov: sqrt(n) D exceeds 1.95 with probability 0.001. Steps of 1 / 100 in p add at most 0.01.
    EXPECT_LT(Kolmogorov(values), 1.95 / std::sqrt(kSeeds) + 0.01) << name;
  }
}

TEST(Screen, BlamesAWrongNoiseFigureOnTheNoiseAndNotOnStructure) {
  constexpr int kFew = 40;
  for (const auto& [name, values] : NullPValues(kFew, 1.25)) {
    const auto low = std::count_if(values.begin(), values.end(), [](double v) { return v < 0.01; });
    // 384 rows tell the level to 4 %; the other tests are below 0.01 in 0.4 of 40 runs: 5 has probability 1e-4.
    if (name == "fit to stated noise")
      EXPECT_EQ(low, kFew);
    else
      EXPECT_LT(low, 5) << name;
  }
}

TEST(PValue, CountsTheNullsThatAreAtLeastAsLarge) {
  Eigen::VectorXd statistic = Eigen::VectorXd::LinSpaced(100, 0.0, 99.0);  // entry 0 is the run
  statistic[0] = 50.0;
  // 50, 51, ..., 99 and the run itself: 51 of 100.
  EXPECT_DOUBLE_EQ(screen::PValue(statistic), 0.51);
}

TEST(PValue, GoesOnBeyondTheLargestNullAsAnExponential) {
  // Quantiles of an exponential of mean 1: the fitted tail must give exp(-t).
  Eigen::VectorXd statistic(1001);
  for (int i = 1; i <= 1000; ++i) statistic[i] = -std::log((i - 0.5) / 1000.0);
  statistic[0] = 14.0;
  // The mean excess of 100 quantiles is within 1 % of 1; over the 11.7 from threshold to 14 that is 12 % of p.
  EXPECT_NEAR(screen::PValue(statistic) / std::exp(-14.0), 1.0, 0.15);
}

}  // namespace
}  // namespace twinbench::diagnose
