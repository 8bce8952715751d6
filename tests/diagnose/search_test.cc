#include "twin/diagnose/engine/search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/diagnose/ring_run.h"
#include "twin/core/units.h"
#include "twin/diagnose/engine/prior.h"

namespace twinbench::diagnose {
namespace {

using test::NoisyRing;
using test::WhiteNoise;

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
  SearchResult Find(double threshold) {
    noise = WhiteNoise(run);
    projector = std::make_unique<Projector>(noise.Whiten(run, run.nuisance.jacobian), run.nuisance);
    const Scanner scanner(run, noise, *projector, families);
    return Search(run, noise, *projector, scanner, LogPriors(families), threshold, 4);
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
  const Projector projector(noise.Whiten(c.run, c.run.nuisance.jacobian), c.run.nuisance);
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
}

TEST(Search, PicksTheCauseThatIsThereWithItsSize) {
  SearchCase c(2);
  c.run.residual += 3.0 * units::um * Drift(c.run);
  const SearchResult found = c.Find(3.0);
  ASSERT_EQ(found.terms.size(), 1U);
  EXPECT_EQ(c.families[static_cast<std::size_t>(found.terms[0].family)].effect, "drift");
  EXPECT_NEAR(found.terms[0].amplitudes[0], 3.0 * units::um, 4.0 * std::sqrt(found.terms[0].cov(0, 0)));
}

TEST(Search, PicksTwoCausesAtOnce) {
  SearchCase c(3);
  c.run.residual += 4.0 * units::um * Drift(c.run) + 3.0 * units::um * OneChannel(c.run, Drift(c.run), 0);
  const SearchResult found = c.Find(3.0);
  ASSERT_EQ(found.terms.size(), 2U);
  EXPECT_NE(found.terms[0].family, found.terms[1].family);
  EXPECT_LT(found.last_statistic, 3.0);
}

TEST(Search, FindsNothingInNoise) {
  int found = 0;
  for (std::uint64_t seed = 10; seed < 110; ++seed) found += SearchCase(seed).Find(3.0).terms.empty() ? 0 : 1;
  // Odds of e^3 = 20 against none: by Markov's inequality at most one in twenty, as a rule far fewer.
  EXPECT_LE(found, 5);
}

TEST(NullCalibration, ExtendsItsTailBeyondTheSimulatedRuns) {
  NullCalibration null;
  for (int k = 0; k < 1000; ++k) null.sorted.push_back(-2.0 * std::log(1.0 - (k + 0.5) / 1000.0));  // mean excess 2
  EXPECT_NEAR(null.Threshold(0.01), -2.0 * std::log(0.01), 0.2);
  EXPECT_NEAR(null.PValue(-2.0 * std::log(1e-5)), 1e-5, 4e-6);
}

}  // namespace
}  // namespace twinbench::diagnose
