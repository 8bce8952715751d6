#include "tests/core/input_error.h"
#include "tests/investigate/hidden_investigation.h"
#include "tests/support/twin_run.h"
#include "twin/benches/registry.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/core/bench_format.h"
#include "twin/investigate/hidden_run.h"

namespace twinbench::investigate {
namespace {

InvestigationOptions WithBudget(double budget_min) {
  InvestigationOptions options;
  options.budget_min = budget_min;
  return options;
}
InvestigationOptions TenHours() {
  return WithBudget(600.0);
}

Judged Hidden(hidden::Design design, const std::string& effect, const std::string& where, double rho,
              double budget_min = 600.0, std::uint64_t seed = 7, const std::optional<Wish>& wish = {}) {
  return InvestigateHidden({effect, where, design}, seed, rho, hidden::ScaleOf(design), WithBudget(budget_min), wish);
}

TEST(Investigate, TellsACauseThatTheFirstRunDoesNotTellFromOthers) {
  const Judged judged = Hidden(hidden::Design::kSweep, "clock_rate", "", 4.5);
  ASSERT_TRUE(judged.tied_at_first) << judged.answer;
  EXPECT_EQ(judged.result, Result::kRight) << judged.answer;
  EXPECT_GT(judged.probability, 0.95);
}

TEST(Investigate, SaysThatAnEccentricRingAndAnOffsetOfSignalsCannotBeTold) {
  const Judged judged = Hidden(hidden::Design::kStops, "eccentricity", "", 15.0);
  EXPECT_EQ(judged.result, Result::kRightTie) << judged.answer;
  EXPECT_EQ(judged.investigation.ended, Ended::kNothingMore);
  EXPECT_GT(judged.investigation.belief.open.at(1).probability, 0.05) << judged.answer;
}

TEST(Investigate, EndsWithItsBudget) {
  const Judged judged = Hidden(hidden::Design::kStops, "slip", "", 12.0, 1.0);
  EXPECT_EQ(judged.investigation.steps.size(), 1u);  // the scenario's own run is made in any case
  ASSERT_TRUE(judged.tied_at_first) << judged.answer;
  EXPECT_EQ(judged.investigation.ended, Ended::kBudget);
}

// A wander may look like a slip in one run, and goes on in the next.
TEST(Investigate, SeesWhetherASlipHappensAgain) {
  const hidden::SignatureScale& scale = hidden::ScaleOf(hidden::Design::kTurntable);
  InvestigationOptions options = TenHours();
  options.conclusive = 0.9;
  const Judged judged = InvestigateHidden({"slip", "x", hidden::Design::kTurntable}, 7, 15.0, scale, options);
  const std::vector<Step>& steps = judged.investigation.steps;
  EXPECT_EQ(steps.front().believed.front().first, "slip x");
  ASSERT_GT(steps.size(), 1u);
  EXPECT_THAT(steps[1].reason, testing::HasSubstr("slip x happened in the last run: whether it does so again"));
  EXPECT_EQ(judged.investigation.belief.Best().fit.hypothesis.Name(), "slip x") << judged.answer;
  EXPECT_GT(judged.probability, 0.9) << judged.answer;  // another run says no more of when it happened
}

TEST(Investigate, LooksAgainWhereOneRunMayHideACause) {
  const std::vector<hidden::UnlistedCause> causes = hidden::UnlistedCausesOf("encoder_comparison");
  const auto line = std::ranges::find(causes, "non-integer line", &hidden::UnlistedCause::name);
  ASSERT_NE(line, causes.end());
  const hidden::SignatureScale& scale = hidden::ScaleOf(hidden::Design::kSweep);
  const Judged judged = InvestigateUnlisted(hidden::Design::kSweep, *line, 2, 4.0, scale, TenHours());
  const std::vector<Step>& steps = judged.investigation.steps;
  EXPECT_EQ(steps.front().believed.front().first, "nothing");
  EXPECT_EQ(judged.result, Result::kRight) << judged.answer;
  ASSERT_GT(steps.size(), 1u);
  EXPECT_THAT(steps[1].reason, testing::HasSubstr("nothing found so far: 6.25 runs like the first"));
}

/// Runs of the twin of `hidden`.
Laboratory LaboratoryOf(const Scenario& hidden, const Scenario& believed) {
  Laboratory laboratory;
  laboratory.measure = [=](const Step& step, const Scenario& asked) {
    return hidden::TakeReadings(HiddenRun(hidden, believed, step.run, asked.repeat));
  };
  return laboratory;
}

TEST(Investigate, OneThatFindsNothingSaysSo) {
  const Scenario believed = hidden::Believed(hidden::Design::kStops);
  const Investigation found = Investigate(believed, TenHours(), MeansOf(believed), LaboratoryOf(believed, believed));
  EXPECT_EQ(found.told, Told::kNothing);
  EXPECT_EQ(found.steps.size(), 2u);  // one of 16 readings a stop is more than (5 / 2)^2 like the first
}

// Noise hides it in a run, and not in one with longer readings.
TEST(Investigate, MakesReadingsLongerWhereNothingIsFound) {
  const Judged judged = Hidden(hidden::Design::kRotary, "tone", "yaw", 2.8);
  const std::vector<Step>& steps = judged.investigation.steps;
  EXPECT_EQ(steps.front().believed.front().first, "nothing");
  ASSERT_GT(steps.size(), 1u);
  EXPECT_EQ(steps[1].run.name, "longer-readings") << steps[1].reason;
  EXPECT_EQ(judged.investigation.belief.Best().fit.hypothesis.Name(), "tone yaw") << judged.answer;
}

// The same wave without a name is sought on fewer periods: that is no evidence for it.
TEST(Investigate, NamesARippleOfAnyPeriod) {
  const Judged judged = Hidden(hidden::Design::kTurntable, "autocollimator_periodic", "y", 15.2, 600.0, 28001);
  EXPECT_EQ(judged.investigation.steps.front().believed.front().first, "autocollimator_periodic y") << judged.answer;
  EXPECT_EQ(judged.result, Result::kRight) << judged.answer;
}

// Which readings they meet no hypothesis says: a fit that followed them would be one to them.
TEST(Investigate, GoesOnBesideSingleDisturbedReadings) {
  const Judged judged =
      Hidden(hidden::Design::kTurntable, "outliers", "", 4.5, 2000.0, 51006, Wish{"turntable.ez_arcsec", 2.0});
  EXPECT_EQ(judged.investigation.belief.Best().fit.hypothesis.Name(), "outliers") << judged.answer;
  EXPECT_TRUE(judged.investigation.IsGoalMet());
}

// The orders of one are counted in lines, those of the other in turns.
TEST(Investigate, LeavesEachOfATieItsOwnOrder) {
  const Judged judged = Hidden(hidden::Design::kSweepAllKnown, "interpolation", "", 10.7, 600.0, 28021);
  EXPECT_EQ(judged.result, Result::kRightTie) << judged.answer;
  EXPECT_GT(judged.probability, 0.3) << judged.answer;
}

// Two set-ups of one pass leave nothing to find causes by. One that does comes next; both count.
TEST(Investigate, MakesARunThatCanBeDiagnosedWhereTheFirstCannot) {
  Scenario believed = hidden::Believed(hidden::Design::kRotary);
  RotaryOf(believed).procedure.positions = 12;
  RotaryOf(believed).procedure.shifts = {0, 1};
  RotaryOf(believed).procedure.passes = {1};
  Scenario hidden = believed;
  hidden.effects.push_back({"psd_roll", "psd_a", {{"roll", 5e-3}}, ""});
  Laboratory laboratory = LaboratoryOf(hidden, believed);
  const Means means = MeansOf(believed);
  const Investigation found = Investigate(believed, TenHours(), means, laboratory);
  ASSERT_GT(found.steps.size(), 1u);
  EXPECT_EQ(found.steps.front().believed.front().first, "nothing");
  EXPECT_THAT(found.steps[1].reason, testing::HasSubstr("the runs so far cannot be diagnosed: "));
  EXPECT_EQ(found.belief.Best().fit.hypothesis.Name(), "psd_roll psd_a");
  laboratory.confirm = [](const Step&, const std::vector<Advice>&) { return false; };
  const Investigation declined = Investigate(believed, TenHours(), means, laboratory);
  EXPECT_EQ(declined.told, Told::kTied) << "nothing was looked for, so nothing is not what was found";
  EXPECT_EQ(declined.ended, Ended::kDeclined);
}

TEST(Investigate, RefusesAGoalThatAStandardPutsOutOfReachBeforeAnythingIsMeasured) {
  const Scenario believed = LoadScenario(TWINBENCH_SOURCE_DIR "/scenarios/turntable_autocollimator.toml",
                                         {"autocollimator.u_gain_error=0.05"});
  Laboratory laboratory;
  laboratory.measure = [](const Step&, const Scenario&) -> std::vector<Reading> {
    throw std::logic_error("nothing shall be measured");
  };
  InvestigationOptions options;
  options.goal = ParseGoal("turntable.ez 0.1arcsec");
  const std::string message = MessageOf([&] { Investigate(believed, options, MeansOf(believed), laboratory); });
  EXPECT_THAT(message, testing::HasSubstr("cannot be reached"));
  EXPECT_THAT(message, testing::HasSubstr("autocollimator.gain_error"));
}

TEST(HiddenRun, MovesWhatTheRunMovesAndLeavesWhatIsWrong) {
  const Scenario believed = hidden::Believed(hidden::Design::kRotary);
  Scenario hidden = believed;
  hidden.environment.temperature_degC += 1.5;  // the thermometer errs
  const plan::NextRun warm = {
      "warm", "", {"environment.temperature_degC=23", "procedure.passes=[1]"}, plan::kOtherKind};
  const Scenario made = HiddenRun(hidden, believed, warm, 3);
  EXPECT_NEAR(made.environment.temperature_degC, 24.5, 1e-12);
  EXPECT_EQ(RotaryOf(made).procedure.passes, std::vector<int>{1});
  EXPECT_EQ(made.repeat, 3);
  EXPECT_EQ(made.seed, hidden.seed);
  EXPECT_FALSE(IsProcedureAlone(warm));
}

TEST(HiddenRun, IsMadeOnEveryBench) {
  for (const std::string& bench : BenchNames()) {
    const Scenario believed = LoadScenario(test::ScenarioPath(bench + ".toml"));
    EXPECT_EQ(WriteScenario(HiddenRun(believed, believed, {}, believed.repeat)), WriteScenario(believed)) << bench;
  }
}

// A run that the bench's own diagnosis refuses is none.
TEST(NextRuns, LeaveSomethingToFindCausesBy) {
  for (const hidden::Design design : {hidden::Design::kRotary, hidden::Design::kTurntable, hidden::Design::kSweep}) {
    const Scenario scenario = hidden::Believed(design);
    const Means means = MeansOf(scenario);
    for (const plan::NextRun& run : means.next_runs(scenario)) {
      const Scenario other = Altered(scenario, run.sets);
      EXPECT_NO_THROW(means.against(means.twin(other), other)) << scenario.bench << " " << run.name;
    }
  }
}

TEST(Repeat, IsAnotherRunOfTheSameBench) {
  Scenario scenario = hidden::Drawn(hidden::Design::kRotary, 5);
  const auto target_at = [&](int repeat) {
    scenario.repeat = repeat;
    return BenchOf(scenario).make_twin(scenario)->Truth().at("target").dump();
  };
  const auto first_V = [&](int repeat) {
    scenario.repeat = repeat;
    return hidden::TakeReadings(scenario).front().mean_V[0];
  };
  EXPECT_EQ(target_at(0), target_at(4));
  EXPECT_NE(first_V(0), first_V(4));
  EXPECT_EQ(first_V(4), first_V(4));
}

}  // namespace
}  // namespace twinbench::investigate
