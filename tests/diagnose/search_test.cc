#include "twin/diagnose/engine/search.h"

#include <limits>

#include "tests/diagnose/ring_run.h"
#include "tests/support/over_seeds.h"
#include "twin/core/units.h"
#include "twin/diagnose/engine/naming.h"
#include "twin/diagnose/engine/null_calibration.h"
#include "twin/diagnose/engine/prior.h"

namespace twinbench::diagnose {
namespace {

using test::NoisyRing, test::WhiteNoise;

Family Fixed(const std::string& name, const Eigen::MatrixXd& columns, double prior_sd) {
  Family family;
  family.effect = family.group = name;
  family.amplitudes.assign(static_cast<std::size_t>(columns.cols()), {"amplitude", "um", units::um, prior_sd});
  family.columns = [columns](int) { return columns; };
  return family;
}

Eigen::VectorXd Drift(const LinearRun& run) {
  Eigen::VectorXd drift(run.Rows());
  for (int k = 0; k < run.Rows(); ++k) drift[k] = run.ReadingOf(k) / static_cast<double>(run.schedule.Readings());
  return drift;
}

Eigen::VectorXd OneChannel(const LinearRun& run, const Eigen::VectorXd& rows, int channel) {
  Eigen::VectorXd only = Eigen::VectorXd::Zero(rows.size());
  for (int k = 0; k < run.Rows(); ++k) only[k] = run.ChannelOf(k) == channel ? rows[k] : 0.0;
  return only;
}

/// A run with a few causes to choose from.
struct SearchCase {
  explicit SearchCase(std::uint64_t seed) : run(NoisyRing(seed)) {
    const Eigen::VectorXd drift = Drift(run);
    families = {Fixed("drift", drift, units::um), Fixed("drift of one", OneChannel(run, drift, 0), units::um),
                Fixed("bow", drift.cwiseAbs2(), units::um)};
  }
  SearchResult Find(double threshold, int most_causes = 4) {
    noise = WhiteNoise(run);
    projector = std::make_unique<Projector>(noise.Whiten(run, run.nuisance.jacobian), run.nuisance);
    const Scanner scanner(run, noise, *projector, families);
    return Search(run, noise, *projector, scanner, LogPriors(families), threshold, {.most_causes = most_causes, .together = true});
  }
  LinearRun run;
  NoiseModel noise;
  std::unique_ptr<Projector> projector;
  std::vector<Family> families;
};

TEST(Scanner, GivesTheBayesFactorOfOneColumnInClosedForm) {
  SearchCase c(1);
  c.run.residual += 0.5 * units::um * Drift(c.run);
  const NoiseModel noise = WhiteNoise(c.run);
  const Projector projector = ProjectorOf(c.run, noise);
  const Scanner scanner(c.run, noise, projector, c.families);
  const Eigen::MatrixXd white = noise.Whiten(c.run, Eigen::MatrixXd(c.run.residual));
  const Evidence evidence = scanner.Scan(Project(projector, {}, white), {});
  const Eigen::MatrixXd s = noise.Whiten(c.run, Eigen::MatrixXd(Drift(c.run)));
  const double gram = s.col(0).dot(projector.Apply(s).col(0)),
               product = s.col(0).dot(projector.Apply(white).col(0));
  const double power = 20.0 + white.col(0).dot(projector.Apply(white).col(0));
  const double half = 0.5 * (20.0 + projector.DegreesOfFreedom());
  double mean = 0.0;
  for (const double scale : {0.25, 1.0, 4.0}) {
    const double d2 = std::pow(scale * units::um, 2) * gram;
    const double explained = product * product / gram * d2 / (1.0 + d2);
    mean += std::exp(-0.5 * std::log1p(d2) - half * std::log(1.0 - explained / power)) / 3.0;
  }
  EXPECT_NEAR(evidence.log_bayes(0, 0), std::log(mean), 1e-8);
  EXPECT_EQ(Scanner(c.run, noise, projector, c.families, 3).Scan(Project(projector, {}, white), {}).log_bayes, evidence.log_bayes);
}

TEST(Search, PicksTwoCausesAtOnceUnlessFewerAreAllowed) {
  SearchCase c(3);
  c.run.residual += 4.0 * units::um * Drift(c.run) + 3.0 * units::um * OneChannel(c.run, Drift(c.run), 0);
  EXPECT_EQ(c.Find(3.0, 1).terms.size(), 1U);
  const SearchResult found = c.Find(3.0);
  ASSERT_EQ(found.terms.size(), 2U);
  EXPECT_NE(found.terms[0].family, found.terms[1].family);
  EXPECT_LT(found.last_statistic, 3.0);
}

TEST(Search, FindsNothingInNoise) {
  // Odds of e^3 = 20 against none: by Markov's inequality at most one in twenty, as a rule far fewer.
  EXPECT_LE(
      twinbench::test::CountOverSeeds(100, [](auto seed) { return !SearchCase(seed).Find(3.0).terms.empty(); }), 5);
}

/// A slow cosine of the run, so many times.
Eigen::VectorXd Cosine(const LinearRun& run, int times) {
  return (units::kPi * times * Drift(run)).array().cos();
}

TEST(Search, FindsCausesThatAreThereTogetherBesideWhatImitatesTheirSum) {
  SearchCase c(4);
  c.families.clear();
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(c.run.Rows());
  for (int k = 1; k <= 5; ++k) {
    c.families.push_back(Fixed("cause " + std::to_string(k), Cosine(c.run, k), units::um));
    sum += (2.0 + k) * Cosine(c.run, k);
  }
  // It explains nearly all of it at the first step, and leaves no room for the five.
  c.families.push_back(Fixed("imitator", sum + 0.5 * Cosine(c.run, 6), units::um));
  c.families.back().kind = Kind::kUnknown;
  c.run.residual += 1.0 * units::um * sum;
  const SearchResult found = c.Find(3.0);
  ASSERT_EQ(found.terms.size(), 5U);
  for (const Term& term : found.terms) {
    ASSERT_LT(term.family, 5);
    EXPECT_NEAR(term.amplitudes[0], (3.0 + term.family) * units::um, 4.0 * std::sqrt(term.cov(0, 0)));
  }
}

/// One place of the answer that a wave of this order fills for sure.
Term SureOrder(double order) {
  return {.shape = Eigen::VectorXd::Constant(1, order), .columns = Eigen::VectorXd::Ones(8),
          .log_posterior = Eigen::Vector2d(0.0, -50.0), .statistic = 50.0, .explained = 100.0,
          .amplitudes = Eigen::VectorXd::Constant(1, units::um), .cov = 1e-16 * Eigen::MatrixXd::Identity(2, 2)};
}

TEST(Name, TellsTwoOrdersOfOneEffectAsTwoCauses) {
  Family wave = Fixed("periodic", Eigen::VectorXd::Ones(8), units::um);
  wave.shapes = {{"order", "1", 1.0, 1.0, 24.0, {3.0, 5.0}}};
  wave.grid = 2;
  SearchResult found{.terms = {SureOrder(3.0), SureOrder(5.0)}, .joint_evidence = 100.0,
                     .alone = {Eigen::MatrixXd::Zero(1, 1), Eigen::MatrixXi::Zero(1, 1), Eigen::MatrixXd::Zero(1, 1)}};
  const Naming naming = Name(found, {wave}, 5.0);
  ASSERT_EQ(naming.causes.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    ASSERT_EQ(naming.causes[k].parameters.back().name, "order");
    EXPECT_EQ(naming.causes[k].parameters.back().value, k == 0 ? 3.0 : 5.0);
  }
}

TEST(NullCalibration, IsKeptForRunsOfNearlyTheSameNoiseAndOfNoOtherSizes) {
  const SearchCase c(1);
  const auto key = [](LinearRun run, double noise, std::vector<Family> families) {
    run.sigma *= noise;
    return DesignKey(run, families, 1000);
  };
  const std::string kept = key(c.run, 1.0, c.families);
  EXPECT_EQ(key(c.run, 1.02, c.families), kept);
  EXPECT_NE(key(c.run, 3.0, c.families), kept);
  std::vector<Family> larger = c.families, finer = c.families;
  larger.back().amplitudes.front().prior_sd *= 100.0;
  finer.back().grid *= 20;
  EXPECT_NE(key(c.run, 1.0, larger), kept);
  EXPECT_NE(key(c.run, 1.0, finer), kept);
}

TEST(NullCalibration, ExtendsItsTailBeyondTheSimulatedRuns) {
  NullCalibration null;
  for (int k = 0; k < 1000; ++k) null.sorted.push_back(-2.0 * std::log(1.0 - (k + 0.5) / 1000.0));  // mean excess 2
  EXPECT_NEAR(null.Threshold(0.01), -2.0 * std::log(0.01), 0.2);
  EXPECT_NEAR(null.PValue(-2.0 * std::log(1e-5)), 1e-5, 4e-6);
}

// What both channels show looks like a cause on both, where rows are taken for independent.
TEST(NullCalibration, KnowsThatAllChannelsOfAReadingShowOneDraw) {
  constexpr int kRuns = 1000;
  constexpr double kShare = 0.9;
  SearchCase c(1);
  const NoiseModel noise = WhiteNoise(c.run);
  const Projector projector = ProjectorOf(c.run, noise);
  const Scanner scanner(c.run, noise, projector, c.families);
  const Eigen::VectorXd priors = LogPriors(c.families);
  const double as_if_white = Calibrate(c.run, scanner, projector, priors, 1000).Threshold(0.05);
  c.run.draws = kShare * c.run.sigma;
  const double threshold = Calibrate(c.run, scanner, projector, priors, 1000).Threshold(0.05);
  Stream stream(5, "test.draws");
  Eigen::MatrixXd white(c.run.Rows(), kRuns);
  for (int k = 0; k < kRuns; ++k) {
    for (int row = 0; row < c.run.Rows(); row += 2) {
      const double draw = kShare * stream.Normal(), own = std::sqrt(1.0 - kShare * kShare);
      white(row, k) = draw + own * stream.Normal();
      white(row + 1, k) = draw + own * stream.Normal();
    }
  }
  const Eigen::ArrayXd statistic = AlarmStatistic(scanner.Scan(Project(projector, {}, white), {}).log_bayes, priors);
  const auto alarms = (statistic > threshold).count();
  // 50 of 1000, 7 by chance, and as much that the threshold itself scatters.
  EXPECT_GT(alarms, 20);
  EXPECT_LT(alarms, 80);
  EXPECT_GT((statistic > as_if_white).count(), 1.4 * static_cast<double>(alarms));
}

constexpr double kDecaying_m = 6.0 * units::um, kLifetime_s = 200.0;

/// What both channels show of a decay over an unknown time.
Family Decay(const LinearRun& run) {
  Family family;
  family.effect = family.group = "decay";
  family.amplitudes = {{"amplitude", "um", units::um, 3.0 * units::um}};
  family.shapes = {{"lifetime", "s", 1.0, 10.0, 5000.0, {30.0, 100.0, 300.0, 900.0}}};
  family.grid = 4;
  family.at = [time_s = Eigen::VectorXd(Drift(run) * 5.0 * run.schedule.Readings())](const Eigen::VectorXd& shape) {
    return Eigen::MatrixXd((-time_s.array() / shape[0]).exp());
  };
  family.columns = [at = family.at, value = family.shapes[0].value](int g) {
    return at(Eigen::VectorXd::Constant(1, value[static_cast<std::size_t>(g)]));
  };
  return family;
}

/// Shares of many runs whose 95 % intervals hold amplitude and lifetime, with a noise of so many times the stated one.
Eigen::Vector2d CoverageOf95(double noise) {
  return twinbench::test::MeanOverSeeds(200, [noise](std::uint64_t seed) {
    SearchCase c(seed);
    c.families = {Decay(c.run)};
    c.run.residual = noise * c.run.residual + kDecaying_m * c.families[0].at(Eigen::VectorXd::Constant(1, kLifetime_s));
    const Term term = c.Find(-std::numeric_limits<double>::infinity(), 1).terms.at(0);  // its size is asked for, not whether it is there
    const Eigen::Vector2d off(term.amplitudes[0] - kDecaying_m, term.shape[0] - kLifetime_s);
    const Eigen::Array2d u = term.cov.diagonal().head(2).cwiseSqrt();
    return Eigen::Vector2d((off.array().abs() <= 1.96 * u).cast<double>());
  });
}

// 0.95 less three deviations of 200 runs is 0.90. A lifetime enters in curves, which costs a little more.
TEST(Estimate, IntervalsOfAnAmplitudeAndItsLifetimeHoldTheTruthAndGrowWhereTheNoiseIsLargerThanStated) {
  const Eigen::Vector2d share = CoverageOf95(1.0);
  EXPECT_GE(share[0], 0.90);
  EXPECT_GE(share[1], 0.88);
  EXPECT_GE(CoverageOf95(1.6)[0], 0.90);
}

}  // namespace
}  // namespace twinbench::diagnose
