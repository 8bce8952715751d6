#include "tests/foreign/answer.h"

#include <gtest/gtest.h>

#include "tests/support/twin_run.h"
#include "twin/benches/names.h"

namespace twinbench::foreign {
namespace {

using diagnose::Diagnosis, diagnose::Verdict;

Diagnosis Naming(const std::string& effect, double probability) {
  Diagnosis d;
  d.verdict = Verdict::kNamed;
  d.causes.resize(1);
  d.causes[0].effect = effect;
  d.causes[0].probability = probability;
  return d;
}

Truth WarmUp() {
  Truth truth = Unlisted({"drift"});
  truth.kind = "warm-up";
  return truth;
}

TEST(ForeignJudge, TakesANearNameForNoErrorAndAnotherForOne) {
  EXPECT_TRUE(Judge(WarmUp(), Naming("drift", 0.97)).wrong.empty());
  const Answer wrong = Judge(WarmUp(), Naming("hysteresis", 0.97));
  EXPECT_EQ(wrong.wrong, "hysteresis");
  EXPECT_TRUE(IsSurelyWrong(wrong) && !IsRight(wrong));
}

TEST(ForeignJudge, MissesWhatIsNeitherNamedNorSaidToBeUnknown) {
  Truth truth = WarmUp();
  truth.listed = {{"eccentricity"}, {"scale"}};
  Diagnosis d = Naming("scale", 0.9);
  EXPECT_EQ(Judge(truth, d).missing, 2);
  d.causes[0].indistinguishable_from = {{"eccentricity", "", 0.99}};
  EXPECT_EQ(Judge(truth, d).missing, 1);
  d.unknown.signature = "slow wander";
  EXPECT_EQ(Judge(truth, d).missing, 0);
}

/// Readings that drift, by hand.
std::vector<Reading> Drifting(const Run& run) {
  std::vector<Reading> readings;
  for (int k = 0; k < 60; ++k) {
    Reading& r = readings.emplace_back();
    r.reading = k;
    r.time = Time(FromSeconds((30.0 + static_cast<double>(run.seed)) * k));
    r.reference_rad = 11.0 * k * units::deg;
    r.measured_rad = r.reference_rad + (run.faults ? 0.02 * units::deg * ToSeconds(r.time) / 3600.0 : 0.0);
  }
  return readings;
}

/// Of a drift at `share` of its rate, 1 - (1 - share)^2 of its square is explained.
TEST(ForeignGain, IsTheShareThatTheFileExplainsOfAnotherRun) {
  const Machine machine{{}, LoadScenario(test::ScenarioPath("encoder_comparison.toml")), Drifting};
  for (const double share : {0.0, 0.5, 1.0, 2.5}) {
    Scenario extended = machine.believed;
    extended.effects.push_back(
        {"drift", "", {{"rate", share * 0.02 * units::deg / 3600.0}, {"curvature", 0.0}, {"warm_up", 0.0}}, ""});
    EXPECT_NEAR(GainOn(machine, extended), 1.0 - (1.0 - share) * (1.0 - share), 1e-4) << share;
  }
}

}  // namespace
}  // namespace twinbench::foreign
