#include "twin/diagnose/engine/autoregression.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/diagnose/ring_run.h"
#include "twin/core/stream.h"

// Noise that remembers more than its neighbour.
namespace twinbench::diagnose {
namespace {

using test::NoisyRing;

/// x_k = a x_(k-1) + b x_(k-2) + e_k, from its second thousand on.
Eigen::VectorXd DrawnSeries(double a, double b, int count, std::uint64_t seed) {
  constexpr int kRunIn = 1000;
  Stream stream(seed, "autoregression");
  Eigen::VectorXd x = Eigen::VectorXd::Zero(kRunIn + count);
  for (Eigen::Index k = 2; k < x.size(); ++k) x[k] = a * x[k - 1] + b * x[k - 2] + stream.Normal();
  x = x.tail(count).eval();
  return x / std::sqrt(x.squaredNorm() / count);
}

std::vector<int> InOnePass(int count) {
  std::vector<int> before(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) before[static_cast<std::size_t>(k)] = std::min(k, 8);
  return before;
}

TEST(Autoregression, PredictsByTheWeightsThatASeriesWasMadeWith) {
  // A resonance: neighbours are alike, those three apart are opposite.
  const FittedAutoregression fitted = FitAutoregression(DrawnSeries(1.2, -0.6, 3000, 1), InOnePass(3000), 1);
  ASSERT_EQ(fitted.series.Order(), 2u);
  const Forecast forecast = ForecastsOf(fitted.series).back();
  EXPECT_NEAR(forecast.weights[0], 1.2, 0.05);
  EXPECT_NEAR(forecast.weights[1], -0.6, 0.05);
  // Of a unit series: (1 - r1 a - r2 b), with r1 = a / (1 - b) and r2 = a r1 + b.
  EXPECT_NEAR(forecast.left, std::sqrt(1.0 - 1.2 * 0.75 + 0.6 * 0.3), 0.03);
}

TEST(Autoregression, RemembersNoMoreThanItsNeighbourWhereThatIsAll) {
  int longer = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed)
    longer += FitAutoregression(DrawnSeries(0.5, 0.0, 900, seed), InOnePass(900), 1).series.Order() > 1;
  EXPECT_LE(longer, 1);
}

TEST(Autoregression, OfShortSeriesItAsksForNeighboursOnly) {
  EXPECT_EQ(FitAutoregression(DrawnSeries(1.2, -0.6, 100, 3), InOnePass(100), 1).series.Order(), 1u);
}

TEST(Autoregression, WhatIsTakenOutOneAfterTheOtherIsAProductOfPolynomials) {
  // (1 - 0.5 B) (1 - 0.8 B + 0.3 B^2) = 1 - 1.3 B + 0.7 B^2 - 0.15 B^3
  const Autoregression second{{0.8 / 1.3, -0.3}};
  ASSERT_NEAR(ForecastsOf(second).back().weights[0], 0.8, 1e-12);
  const std::vector<double> weights = ForecastsOf(InOne({{0.5}}, second)).back().weights;
  ASSERT_EQ(weights.size(), 3u);
  EXPECT_NEAR(weights[0], 1.3, 1e-12);
  EXPECT_NEAR(weights[1], -0.7, 1e-12);
  EXPECT_NEAR(weights[2], 0.15, 1e-12);
}

TEST(NoiseModel, WhitensWhatIsCorrelatedAsItSaysFromTheFirstReadingOfAPassOn) {
  const LinearRun run = NoisyRing(1);
  const NoiseModel noise{run.sigma, {{0.6, -0.4, 0.2}}};
  // Whitening F of rows with covariance C: F C F' = 1, C = (F'F)^-1.
  const Eigen::MatrixXd F = noise.Whiten(run, Eigen::MatrixXd::Identity(run.Rows(), run.Rows()));
  const Eigen::MatrixXd C = (F.transpose() * F).inverse();
  for (int k = 0; k < run.Rows(); ++k) EXPECT_NEAR(C(k, k), run.sigma[k] * run.sigma[k], 1e-9 * C(k, k)) << k;
  const int next = run.Channels();
  EXPECT_NEAR(C(next, 0) / (run.sigma[0] * run.sigma[next]), 0.6, 1e-9);
  const Eigen::MatrixXd Y = noise.WhitenTransposed(run, Eigen::MatrixXd::Identity(run.Rows(), run.Rows()));
  EXPECT_LT((Y - F.transpose()).norm(), 1e-12 * F.norm());
}

}  // namespace
}  // namespace twinbench::diagnose
