#include "twin/benches/rotary_4dof/diagnosis/rotary_run.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/twin_run.h"
#include "twin/benches/rotary_4dof/diagnosis/free_parameters.h"
#include "twin/benches/rotary_4dof/diagnosis/search.h"
#include "twin/benches/rotary_4dof/twin/factory.h"

namespace twinbench::diagnose::rotary {
namespace {

/// What is left of the readings pulls at no free unknown, in units of that unknown's own uncertainty: the normal
/// equations hold.
TEST(RotaryRun, PredictsWhatTheFreeUnknownsFitBest) {
  const Scenario scenario = LoadScenario(twinbench::test::ScenarioPath("rotary_4dof.toml"));
  const RotaryRun rotary =
      BuildRun(twinbench::test::RunTwin(scenario).readings, scenario, {benches::rotary::FollowRecord});
  const LinearRun& run = rotary.run;
  const Eigen::VectorXd weight = run.sigma.cwiseInverse();
  const Eigen::SparseMatrix<double> white = weight.asDiagonal() * run.nuisance.jacobian;
  const Eigen::VectorXd pull = white.transpose() * weight.cwiseProduct(run.residual);
  for (int k = 0; k < CalibratedColumn(rotary.design); ++k) {
    const double length = white.col(k).norm();
    // The wide priors pull at a constant that several unknowns share by some 1e-4 of its uncertainty.
    EXPECT_LT(std::abs(pull[k]), 1e-2 * std::max(length, 1.0)) << "unknown " << k;
  }
}

/// One degree: the tangent at zero is off by a fifth of what the free unknowns leave of the effect.
constexpr double kIncidence_rad = 17e-3;

TEST(RotarySearch, NamesAChangeOfTheBenchThatIsLargeEnoughToBend) {
  const Scenario believed = LoadScenario(twinbench::test::ScenarioPath("rotary_4dof.toml"));
  Scenario actual = believed;
  actual.effects.push_back({"incidence_offset", "", {{"incidence", kIncidence_rad}}, ""});
  DiagnoseOptions options;
  options.null_runs = 100;
  const SearchedRotary searched =
      SearchRotary(twinbench::test::RunTwin(actual).readings, believed, options, {benches::rotary::FollowRecord});
  const SearchResult& found = searched.analysis.found;
  ASSERT_EQ(found.terms.size(), 1U);
  const Term& term = found.terms[0];
  EXPECT_EQ(searched.rotary->Families()[static_cast<std::size_t>(term.family)].effect, "incidence_offset");
  EXPECT_NEAR(term.amplitudes[0], kIncidence_rad, 4.0 * std::sqrt(term.cov(0, 0)));
  EXPECT_LT(std::sqrt(term.cov(0, 0)), 0.1 * kIncidence_rad);
}

}  // namespace
}  // namespace twinbench::diagnose::rotary
