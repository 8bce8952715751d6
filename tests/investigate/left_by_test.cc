#include <gtest/gtest.h>

#include "tests/hidden/bench_runs.h"
#include "tests/investigate/hidden_investigation.h"
#include "twin/benches/registry.h"
#include "twin/core/units.h"
#include "twin/investigate/taken_run.h"

/// A run asks its own twin what another scenario leaves; a run that is built anew against that scenario, with slopes and
/// a fit of its own, says the same.
namespace twinbench::investigate {
namespace {

struct Asked {
  hidden::Design design;
  std::string effect, where, size;
  double value;
};

class LeftByAnotherScenario : public testing::TestWithParam<Asked> {};

TEST_P(LeftByAnotherScenario, IsWhatARunBuiltAnewLeaves) {
  const Scenario believed = hidden::Believed(GetParam().design);
  const Means means = MeansOf(believed);
  TakenRun run = TakenOf({}, believed, hidden::TakeReadings(hidden::Drawn(GetParam().design, 5)), means, 0);
  ASSERT_TRUE(run.linear.left_by_another);
  Supposed cause;
  cause.name = GetParam().effect;
  cause.where = GetParam().where;
  cause.parameters[GetParam().size] = GetParam().value;
  const Hypothesis hypothesis{{cause}, {}, 0.0};
  const Eigen::VectorXd asked = LeftBy(hypothesis, run, means);
  run.linear.left_by_another = nullptr;
  const Eigen::VectorXd anew = LeftBy(hypothesis, run, means);
  const auto length = [&run](const Eigen::VectorXd& white) { return std::sqrt(Product(run, white, white)(0, 0)); };
  EXPECT_GT(length(asked - run.left), 5.0);
  EXPECT_LT(length(asked - anew), 0.1);  // noise standard deviations, of all readings together
}

// Mirrors turned out of an autocollimator's range would show nothing. Readings that were there speak against that.
TEST(LeftByAScenario, ThatShowsNothingIsTheWhole) {
  const Scenario believed = hidden::Believed(hidden::Design::kTurntable);
  const Means means = MeansOf(believed);
  const TakenRun run = TakenOf({}, believed, hidden::TakeReadings(believed), means, 0);
  Supposed cause;
  cause.name = "settling";
  cause.parameters = {{"amplitude", 1.0 * units::deg}, {"time_constant", 1000.0}};
  EXPECT_EQ(LeftBy({{cause}, {}, 0.0}, run, means), run.left);
}

INSTANTIATE_TEST_SUITE_P(Benches, LeftByAnotherScenario,
                         testing::Values(Asked{hidden::Design::kRotary, "psd_roll", "psd_a", "roll", 2e-3},
                                         Asked{hidden::Design::kTurntable, "autocollimator_scale", "", "gain_error", 0.02}));

}  // namespace
}  // namespace twinbench::investigate
