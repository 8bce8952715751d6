#include "tests/foreign/plans.h"
#include "tests/hidden/known_wrong.h"
#include "tests/support/oracle_poses.h"
#include "tests/support/thresholds.h"
#include "tests/support/twin_run.h"
#include "twin/benches/registry.h"
#include "twin/core/units.h"

// A few machines of every sort. What falls short of what is asked - the second diagnosis, the stated gain - is counted by
// tools/scores.
namespace twinbench::foreign {
namespace {

using hidden::Every;

std::vector<Plan> OfSet(const std::string& set, std::vector<Plan> plans) {
  std::erase_if(plans, [&](const Plan& plan) { return plan.set != set; });
  return plans;
}

std::vector<Plan> ReducedPlans() {
  constexpr std::uint64_t kFirstSeed = 51;
  const std::vector<Plan> kinds = KindPlans(1, kFirstSeed), clean = CleanPlans(64, kFirstSeed);
  std::vector<Plan> plans = OfSet("kinds encoder_comparison", kinds);
  for (const auto& part :
       {Every(7, OfSet("kinds rotary_4dof", kinds)),
        OfSet("several encoder_comparison", SeveralPlans(7, kFirstSeed)),
        Every(8, OfSet("clean encoder_comparison", clean)), Every(16, OfSet("clean rotary_4dof", clean))})
    plans.insert(plans.end(), part.begin(), part.end());
  return plans;
}

/// Diagnosed once.
std::vector<hidden::Answered> Answers() {
  std::vector<hidden::Answered> answers;
  for (const Plan& plan : ReducedPlans()) {
    const Machine machine = plan.make();
    const Answer answer = Judge(
        machine.truth, diagnose::Diagnose(machine.readings(kFirst), machine.believed, test::QuickOptions()).diagnosis);
    answers.push_back({plan.set, plan.name, IsRight(answer), "is " + machine.truth.kind + ": " + answer.words});
  }
  return answers;
}

TEST(Foreign, MachinesAreAnsweredRightlySaveForKnownCases) {
  EXPECT_TRUE(hidden::WrongOnlyWhereKnown(Answers()));
}

using diagnose::Diagnosis, diagnose::Verdict;

Diagnosis Naming(const std::string& effect, double probability) {
  return {.verdict = Verdict::kNamed, .causes = {{.effect = effect, .probability = probability}}};
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
    const double t_s = (30.0 + static_cast<double>(run.seed)) * k, at_rad = 11.0 * k * units::deg;
    readings.push_back({.reading = k, .time = Time(FromSeconds(t_s)), .reference_rad = at_rad,
                        .measured_rad = at_rad + (run.faults ? 0.02 * units::deg * t_s / 3600.0 : 0.0)});
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

TableError ErrorOf(const test::OracleError& e) {
  return {e[0], e[1], e[2], e[3], e[4], e[5]};
}

TEST(GratingStand, ShinesWhereTheIndependentPosesSay) {
  const std::vector<test::OraclePose> poses = test::OraclePoses();
  ASSERT_GT(poses.size(), 100U);
  for (const test::OraclePose& pose : poses) {
    const Stacking stacking{pose.target_rad,      pose.reference_rad,      pose.shift_rad, !pose.is_reclamped,
                            ErrorOf(pose.target), ErrorOf(pose.reference), {}};
    const Spots spots = ShineOn(GratingOn(stacking), {});
    const std::array found_m{spots.u_a_m, spots.v_a_m, spots.u_b_m, spots.v_b_m};
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(found_m[k], pose.spots_m[k], 1e-5 * units::um) << k;
  }
}

}  // namespace
}  // namespace twinbench::foreign
