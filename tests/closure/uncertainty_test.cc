#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/rotary_scenario.h"
#include "tests/support/separated_table.h"
#include "tests/support/twin_run.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/core/linear_algebra.h"

namespace twinbench {
namespace {

constexpr int kSeeds = 200;

Scenario NoisyScenario(const std::string& clamping) {
  Scenario scenario = test::RotaryScenario();
  const double as = units::arcsec, um = units::um;
  RotaryOf(scenario).target.random_rms = {4 * as, 4 * as, 5 * as, 2 * um, 2 * um, um};
  RotaryOf(scenario).reference.random_rms = {8 * as, 8 * as, 15 * as, 3 * um, 3 * um, 2 * um};
  RotaryOf(scenario).procedure.clamping = clamping;
  RotaryOf(scenario).procedure.phases = {"full_circle"};  // gains are exact here, so that only the readings scatter
  RotaryOf(scenario).procedure.positions = 12;
  RotaryOf(scenario).procedure.shifts = {0, 1, 4, 6};
  RotaryOf(scenario).procedure.passes = {1, -1};
  RotaryOf(scenario).adc.every_sample = false;
  return scenario;
}

/// Values of the components in one vector, in the order of TableEstimate::cov.
Eigen::VectorXd Stack(const TableErrors& errors, const std::vector<Component>& components) {
  const std::size_t n = errors.position_rad.size();
  Eigen::VectorXd stacked(static_cast<Eigen::Index>(components.size() * n));
  for (std::size_t s = 0; s < components.size(); ++s) {
    for (std::size_t i = 0; i < n; ++i) stacked[static_cast<Eigen::Index>(s * n + i)] = errors[components[s]][i];
  }
  return stacked;
}

/// error' cov^-1 error in the directions that the covariance knows, and how many these are.
std::pair<double, int> ChiSquared(const Eigen::VectorXd& error, const Eigen::MatrixXd& cov) {
  // Angles and lengths are brought to one scale before ranks are counted.
  const Eigen::VectorXd sd = cov.diagonal().cwiseSqrt();
  const Eigen::MatrixXd correlation = sd.cwiseInverse().asDiagonal() * cov * sd.cwiseInverse().asDiagonal();
  const auto [values, vectors] = EigenOfSymmetric(correlation);
  const Eigen::VectorXd scores = vectors.transpose() * error.cwiseQuotient(sd);
  double sum = 0.0;
  int rank = 0;
  for (Eigen::Index k = 0; k < scores.size(); ++k) {
    if (values[k] < 1e-9 * values.maxCoeff()) continue;
    sum += scores[k] * scores[k] / values[k];
    ++rank;
  }
  return {sum, rank};
}

class Scatter : public ::testing::TestWithParam<const char*> {};

TEST_P(Scatter, MatchesTheStatedUncertaintyOver200Seeds) {
  double chi2 = 0.0, dof = 0.0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Scenario scenario = NoisyScenario(GetParam());
    scenario.seed = static_cast<std::uint64_t>(seed);
    const test::TwinRun run = test::RunTwin(scenario);
    for (const test::SeparatedTable& t : test::BothTables(test::Evaluate(run), run.truth)) {
      const std::vector<Component>& components = t.estimate.components;
      const Eigen::VectorXd error = Stack(t.estimate.value, components) - Stack(t.truth, components);
      const auto [sum, rank] = ChiSquared(error, t.estimate.cov.ToDense());
      chi2 += sum;
      dof += rank;
    }
  }
  // chi2 has mean dof and standard deviation sqrt(2 dof) if the two tables were independent; they share readings,
  // which at most doubles its variance. Four of these deviations.
  EXPECT_NEAR(chi2, dof, 4.0 * std::sqrt(4.0 * dof));
  EXPECT_GT(dof, 200 * 60);
}

INSTANTIATE_TEST_SUITE_P(BothClampings, Scatter, ::testing::Values("reclamp", "reseat"));

}  // namespace
}  // namespace twinbench
