#include "twin/campaign/variation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace twinbench::campaign {
namespace {

struct Moments {
  double mean = 0.0, variance = 0.0;
};

/// By the midpoint rule over probability: E[f(X)] is the integral of f(Quantile(p)) over p from 0 to 1.
Moments MomentsOf(const Distribution& distribution) {
  constexpr int kSteps = 200000;
  Moments m;
  double squares = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double x = Quantile(distribution, (i + 0.5) / kSteps);
    m.mean += x / kSteps;
    squares += x * x / kSteps;
  }
  m.variance = squares - m.mean * m.mean;
  return m;
}

TEST(Distributions, HaveTheirMeansAndVariances) {
  const double a = -1.0, c = 0.5, b = 4.0, least = 0.01, most = 10.0, log = std::log(most / least);
  const double mean = (most - least) / log;
  struct Row {
    Distribution distribution;
    double mean, variance, tolerance;
  };
  // The tails of the normal distribution beyond the outermost midpoint hold less than 1e-4 of its variance; the
  // others are bounded and the rule is exact to 1e-9 of their squares.
  const Row rows[] = {
      {Normal{3.0, 0.5}, 3.0, 0.25, 0.25 * 2e-4},
      {Uniform{-1.0, 5.0}, 2.0, 36.0 / 12.0, 1e-6},
      {Triangular{a, c, b}, (a + b + c) / 3.0, (a * a + b * b + c * c - a * b - a * c - b * c) / 18.0, 1e-6},
      {LogUniform{least, most}, mean, (most * most - least * least) / (2.0 * log) - mean * mean, 1e-5}};
  for (const Row& row : rows) {
    const Moments m = MomentsOf(row.distribution);
    EXPECT_NEAR(m.mean, row.mean, 1e-6) << row.mean;
    EXPECT_NEAR(m.variance, row.variance, row.tolerance) << row.mean;
  }
}

TEST(Distributions, NormalLeavesFivePercentOutsideOf1Point96) {
  EXPECT_NEAR(Quantile(Normal{0.0, 1.0}, 0.975), 1.959963984540054, 1e-12);
  EXPECT_NEAR(Quantile(Normal{0.0, 1.0}, 0.025), -1.959963984540054, 1e-12);
}

TEST(Distributions, TriangularMayHaveItsModeAtAnEnd) {
  EXPECT_NEAR(Quantile(Triangular{0.0, 0.0, 1.0}, 0.75), 0.5, 1e-14);  // 1 - (1 - x)^2 = 0.75
  EXPECT_NEAR(Quantile(Triangular{0.0, 1.0, 1.0}, 0.25), 0.5, 1e-14);  // x^2 = 0.25
}

}  // namespace
}  // namespace twinbench::campaign
