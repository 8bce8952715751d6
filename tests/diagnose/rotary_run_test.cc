#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/twin_run.h"
#include "twin/benches/rotary_4dof/bench.h"
#include "twin/benches/rotary_4dof/diagnose.h"

namespace twinbench::diagnose {
namespace {

/// What is left of the readings pulls at a free unknown as its prior, a tenth as wide in the fit, pulls back, in units of
/// that unknown's own uncertainty: the normal equations hold.
TEST(RotaryRun, PredictsWhatTheFreeUnknownsFitBest) {
  const Scenario scenario = LoadScenario(twinbench::test::ScenarioPath("rotary_4dof.toml"));
  const LinearRun run =
      benches::rotary::Linear(twinbench::test::RunTwin(scenario).readings, scenario, Estimator::kRigorous);
  const Eigen::VectorXd weight = run.sigma.cwiseInverse();
  const Eigen::SparseMatrix<double> white = weight.asDiagonal() * run.nuisance.jacobian;
  const Eigen::VectorXd pull = white.transpose() * weight.cwiseProduct(run.observed - run.Predicted());
  const Eigen::VectorXd held = 100.0 * run.nuisance.prior_precision.cwiseProduct(run.nuisance.at);
  const Eigen::Index known = std::ssize(benches::rotary::CalibratedConstants());
  for (Eigen::Index k = 0; k < pull.size() - known; ++k) {
    const double length = white.col(k).norm();
    // The twin is no straight line: by some 1e-3 of an uncertainty behind the last step.
    EXPECT_LT(std::abs(pull[k] - held[k]), 1e-2 * std::max(length, 1.0)) << "unknown " << k;
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
  const Diagnosis found =
      benches::rotary::Diagnose(twinbench::test::RunTwin(actual).readings, believed, options).diagnosis;
  ASSERT_EQ(found.causes.size(), 1U);
  EXPECT_EQ(found.causes[0].effect, "incidence_offset");
  const ParameterEstimate& incidence = found.causes[0].parameters.at(0);
  EXPECT_NEAR(incidence.value, kIncidence_rad, 4.0 * incidence.u);
  EXPECT_LT(incidence.u, 0.1 * kIncidence_rad);
}

}  // namespace
}  // namespace twinbench::diagnose
