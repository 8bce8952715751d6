#include "tests/diagnose/found_causes.h"
#include "tests/diagnose/ring_run.h"
#include "tests/support/over_seeds.h"
#include "twin/diagnose/at_jumps.h"
#include "twin/diagnose/conclusion.h"
#include "twin/diagnose/engine/autoregression.h"
#include "twin/diagnose/engine/noise_causes.h"
#include "twin/diagnose/stated_outliers.h"

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

TEST(Autoregression, RemembersNoMoreThanItsNeighbourWhereThatIsAllOrTheSeriesIsShort) {
  EXPECT_LE(twinbench::test::CountOverSeeds(50, [](auto seed) {
    return FitAutoregression(DrawnSeries(0.5, 0.0, 900, seed), InOnePass(900), 1).series.Order() > 1;
  }), 1);
  // Of short series it asks for neighbours only.
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

using test::WhiteNoise;

/// A run of white noise of the stated size, altered row by row.
template <class Alter>
std::vector<NoiseCause> CausesOf(std::uint64_t seed, const Alter& alter) {
  LinearRun run = NoisyRing(seed);
  alter(run);
  const NoiseModel noise = WhiteNoise(run);
  const Projector projector = ProjectorOf(run, noise);
  const Eigen::VectorXd white = noise.Whiten(run, Eigen::MatrixXd(run.residual));
  // Left out by the plain way: a row without weight.
  const auto without = [&](const std::vector<int>& left_out) {
    Eigen::MatrixXd jacobian = noise.Whiten(run, run.nuisance.jacobian);
    for (const int row : left_out) jacobian.row(row).setZero();
    const Projector others(jacobian.sparseView(), run.nuisance);
    Rest rest{others.Apply(white).col(0), others.Redundancy()};
    rest.redundancy(left_out).setZero();
    return rest;
  };
  return FindNoiseCauses(run, noise, without({}), without);
}

TEST(FindNoiseCauses, HardlyEverRefutesWhiteNoise) {
  const int refuted = twinbench::test::CountOverSeeds(100, [](std::uint64_t seed) {
    return std::ranges::any_of(CausesOf(seed, [](LinearRun&) {}),
                               [](const NoiseCause& c) { return c.log_bayes > 6.0; });
  });
  EXPECT_LE(refuted, 1);
}

TEST(FindNoiseCauses, TakesAFewFarValuesForOutliersAndFindsOneThatBendsTheFitForItsNeighbours) {
  // Two free constants a position and one reading that is far off: without it, none of the others is.
  for (const auto& [rows, off] : {std::pair(std::vector{11, 47, 90}, 15.0), {{47}, 400.0}}) {
    const auto causes = CausesOf(3, [rows = rows, off = off](LinearRun& run) {
      for (const int row : rows) run.residual[row] += off * run.sigma[row];
    });
    ASSERT_FALSE(causes.empty());
    EXPECT_EQ(causes.front().kind, NoiseCause::Kind::kOutliers);
    EXPECT_EQ(causes.front().outliers, rows);
    EXPECT_NEAR(causes.front().outlier_size, off, rows.size() == 1 ? 10.0 : 5.0);
  }
}

TEST(FindNoiseCauses, TakesManyModeratelyFarValuesForTails) {
  const auto causes = CausesOf(4, [](LinearRun& run) {
    Stream stream(5, "tails");
    for (Eigen::Index k = 0; k < run.residual.size(); ++k) {
      run.residual[k] = run.sigma[k] * stream.Normal() / std::sqrt(stream.ChiSquared(3.0) / 3.0);
    }
  });
  ASSERT_FALSE(causes.empty());
  EXPECT_EQ(causes.front().kind, NoiseCause::Kind::kTails);
}

TEST(OutlierCause, CountsReadingsOnceWhateverChannelsOfThemAreFar) {
  const LinearRun run = SyntheticRun({});
  NoiseCause noise;
  noise.outliers = {0, 1, 2, 3, 4 * 7 + 2};
  noise.outlier_size = 30.0;
  const Cause cause = OutlierCause(noise, run);
  ASSERT_EQ(cause.parameters[0].name, "fraction");
  EXPECT_DOUBLE_EQ(cause.parameters[0].value, 2.0 / run.schedule.Readings());
}

/// A run of 1000 readings in which `fraction` of them was found far outside.
DiagnosisRun FoundOutliers(double fraction, double size_m) {
  Cause cause = test::FoundCause("outliers", "", {"fraction", "1", 1.0, fraction, 0.002, 0.0, 0.5});
  cause.parameters.push_back({"size", "um", 1e-6, size_m, 1e-7, 0.0, 1.0});
  DiagnosisRun run = test::NamedRun(cause);
  run.diagnosis.readings = 1000;
  run.diagnosis.alarm_p = 1e-9;
  run.structure_p = 0.4;
  return run;
}

Scenario Stating(double fraction, double size_m) {
  Scenario scenario;
  scenario.effects = {{"outliers", "", {{"fraction", fraction}, {"size", size_m}}, ""}};
  return scenario;
}

TEST(StatedOutliers, AreNoCause) {
  DiagnosisRun run = FoundOutliers(0.012, 2e-6);
  LeaveOutStatedOutliers(Stating(0.01, 2e-6), run);
  EXPECT_TRUE(run.diagnosis.causes.empty());
  EXPECT_EQ(run.diagnosis.verdict, Verdict::kNone);
  EXPECT_EQ(run.diagnosis.alarm_p, 0.4);
  EXPECT_EQ(run.diagnosis.noise.size(), 1u);
}

TEST(StatedOutliers, ThatAreMoreOrLargerOrWithoutAStatementAreStillOne) {
  const std::pair<DiagnosisRun, Scenario> cases[] = {{FoundOutliers(0.03, 2e-6), Stating(0.01, 2e-6)},
                                                     {FoundOutliers(0.01, 20e-6), Stating(0.01, 2e-6)},
                                                     {FoundOutliers(0.01, 2e-6), Scenario{}}};
  for (auto [run, scenario] : cases) {
    LeaveOutStatedOutliers(scenario, run);
    EXPECT_EQ(run.diagnosis.causes.size(), 1u);
    EXPECT_EQ(run.diagnosis.alarm_p, 1e-9);
    EXPECT_EQ(run.diagnosis.verdict, Verdict::kNamed);
  }
}

// A step of 100 u in a wave of 20: a reading within it is on its way, one beyond it or away from it is far from all.
TEST(AwayFromJumps, LeavesOutWhatLiesBetweenBothSidesOfAStepAndNothingElse) {
  LinearRun run = SyntheticSweep(400);
  const double u = run.sigma[0];
  Eigen::VectorXd found(run.Rows()), left = Eigen::VectorXd::Zero(run.Rows());
  for (int row = 0; row < run.Rows(); ++row) found[row] = 20.0 * u * std::sin(0.06 * row) + (row >= 30 ? 100.0 * u : 0.0);
  left[29] = 60.0 * u, left[30] = -90.0 * u, left[31] = -30.0 * u;  // on their way
  left[28] = -60.0 * u, left[33] = -60.0 * u, left[60] = 1.0 * u;   // away from the step, the other way, too late
  left[32] = 140.0 * u;
  EXPECT_EQ(AwayFromJumps({28, 29, 30, 31, 32, 33, 60}, run, found, left), (std::vector<int>{28, 32, 33, 60}));
}

}  // namespace
}  // namespace twinbench::diagnose
