#include "tests/investigate/hidden_investigation.h"
#include "twin/benches/names.h"
#include "twin/investigate/goal.h"
#include "twin/investigate/hypothesis.h"

namespace twinbench::investigate {
namespace {

nlohmann::json Results(double u) {
  return {{"separation",
           {{"target",
             {{"ez_arcsec", {1.0, 2.0}}, {"u_ez_arcsec", {u, u}}, {"dx_um", {0.1, 0.2}}, {"u_dx_um", {9.0, 9.0}}}},
            {"reference", {{"ez_arcsec", {3.0, 4.0}}, {"u_ez_arcsec", {7.0, 7.0}}}}}}};
}

TEST(Goal, IsReadWithItsUnit) {
  const Goal goal = ParseGoal("target.ez 0.1arcsec");
  EXPECT_EQ(goal.quantity, "target.ez");
  EXPECT_EQ(goal.unit, "arcsec");
  EXPECT_EQ(goal.u, 0.1);
  EXPECT_EQ(ParseGoal("ratio 2e-3").u, 2e-3);
  for (const char* bad : {"", "target.ez", "0.1arcsec", "target.ez 0arcsec", "target.ez -1arcsec"})
    EXPECT_THROW(ParseGoal(bad), InputError) << bad;
}

TEST(Goal, NamesWhatCanBeAskedFor) {
  nlohmann::json results = Results(0.3);
  results["terms"] = {{{"amplitude_arcsec", 1.0}, {"u_amplitude_arcsec", 0.1}}};
  EXPECT_EQ(GoalNames(results),
            (std::vector<std::string>{"separation.reference.ez_arcsec", "separation.target.dx_um",
                                      "separation.target.ez_arcsec"}));
}

TEST(Goal, CountsOnlyTheQuantityThatWasAskedFor) {
  Certainty certainty(ParseGoal("target.ez 0.1arcsec"));
  EXPECT_TRUE(std::isinf(certainty.u()));
  EXPECT_TRUE(certainty.Add(Results(0.3)));
  EXPECT_NEAR(certainty.u(), 0.3, 1e-12);
  Certainty other(ParseGoal("target.ey 0.1arcsec"));
  EXPECT_FALSE(other.Add(Results(0.3)));
}

TEST(Goal, RunsAddUpByTheirInverseVariances) {
  Certainty certainty(ParseGoal("target.ez 0.2arcsec"));
  certainty.Add(Results(0.3));
  EXPECT_FALSE(certainty.IsMet());
  EXPECT_NEAR(certainty.With(Results(0.3)), 0.3 / std::sqrt(2.0), 1e-12);
  certainty.Add(Results(0.15));
  EXPECT_NEAR(certainty.u(), 1.0 / std::sqrt(1.0 / 0.09 + 1.0 / 0.0225), 1e-12);
  EXPECT_TRUE(certainty.IsMet());
}

uncertainty::Budget Budget(int place, double standard, double rounding) {
  uncertainty::Budget budget;
  budget.quantity.name = "separation.target.ez_arcsec[" + std::to_string(place) + "]";
  for (const auto& [name, u] : {std::pair{"noise", 0.5}, {"autocollimator.gain_error", standard}, {"quantisation", rounding}}) {
    budget.sources.emplace_back().name = name;
    budget.sources.back().u = u;
  }
  budget.sources.front().type = 'A';
  return budget;
}

TEST(Goal, WhatAllRunsShareIsAddedAndNeverGrowsLess) {
  Certainty certainty(ParseGoal("target.ez 0.2arcsec"));
  certainty.Share({Budget(0, -0.3, 0.1), Budget(1, 0.4, 0.1)});
  EXPECT_NEAR(certainty.SharedU(), std::sqrt((0.09 + 0.16) / 2.0), 1e-12);
  EXPECT_EQ(certainty.LargestShared(), "autocollimator.gain_error");
  for (int run = 1; run <= 4; ++run) {
    certainty.Add(Results(0.6));
    EXPECT_NEAR(certainty.u(), std::sqrt(0.36 / run + 0.125), 1e-12);
  }
}

TEST(Goal, OfWhatARunStatesTheStandardsPartIsNotCountedAgain) {
  nlohmann::json results = Results(0.5);
  results["separation"]["u_parts"] = {{"noise", 0.36}, {"standard", 0.64}};
  Certainty certainty(ParseGoal("target.ez 0.2arcsec"));
  certainty.Add(results);
  EXPECT_NEAR(certainty.u(), 0.3, 1e-12);
  results["separation"]["u_parts"] = {{"noise", 0.36}, {"prior", 0.64}};
  Certainty believed(ParseGoal("target.ez 0.2arcsec"));
  believed.Add(results);
  EXPECT_NEAR(believed.u(), 0.3, 1e-12) << "nor what was believed before";
}

// Five of the score's seeds in a row: a scale, an ellipticity, a slip, a drift, an order of a half. More of them by
// tools/scores --set investigate.
TEST(InvestigateAProgram, TellsWhatABenchHidesThatSharesNothingWithTheTwin) {
  constexpr std::uint64_t kFirst = 5, kLast = 9;
  int right = 0;
  for (std::uint64_t seed = kFirst; seed <= kLast; ++seed) {
    const Judged judged = InvestigateProgram(seed);
    right += judged.IsRight() ? 1 : 0;
    EXPECT_FALSE(judged.result == Result::kWrong && judged.probability > 0.95)
        << judged.truth << ": " << judged.answer;
  }
  EXPECT_GE(right, 4);
}

using diagnose::Cause;

Cause Named(const std::string& effect, double probability) {
  return {.effect = effect, .where = "y", .probability = probability};
}

/// A drift that the answer names, beside a creep that it is too sure of to list.
diagnose::DiagnosisRun DriftFound() {
  diagnose::DiagnosisRun found;
  found.diagnosis = {.verdict = diagnose::Verdict::kNamed, .causes = {Named("autocollimator_drift", 0.85)}};
  Cause creep = Named("mount_creep", 0.1);
  creep.indistinguishable_from = {{"autocollimator_drift", "y"}};
  found.less_likely = {creep};
  return found;
}

Scenario PlainOf(const char* bench) {
  Scenario scenario;
  scenario.bench = bench;
  return scenario;
}
const Scenario kTurntable = PlainOf(kTurntableBench);

TEST(LessLikely, IsOpenBesideWhatTheAnswerNames) {
  const std::vector<Weighed> open = LeftOpen(WithLessLikely(DriftFound()), kTurntable);
  ASSERT_EQ(open.size(), 2u);
  EXPECT_EQ(open[0].hypothesis.Name(), "autocollimator_drift y");
  EXPECT_EQ(open[1].hypothesis.Name(), "mount_creep y");
  EXPECT_NEAR(open[1].probability / open[0].probability, 0.1 / 0.85, 1e-12);
}

TEST(LessLikely, OfACauseThatIsNoLongerToldIsLeftOutAndThatTheAnswerListsIsNotListedTwice) {
  diagnose::DiagnosisRun other = DriftFound(), both = DriftFound();
  other.diagnosis.causes = {Named("tone", 0.9)};
  both.diagnosis.causes.push_back(Named("mount_creep", 0.4));
  EXPECT_EQ(WithLessLikely(other).diagnosis.causes.size(), 1u);
  EXPECT_EQ(WithLessLikely(both).diagnosis.causes.size(), 2u);
}

TEST(LessLikely, IsAsLargeAsItWouldBeAlone) {
  diagnose::DiagnosisRun found = DriftFound();
  Cause creep = Named("mount_creep", 0.0);
  creep.parameters = {{"amplitude", "arcsec", units::arcsec, 0.7 * units::arcsec, 0.1 * units::arcsec, -1.0, 1.0},
                      {"time_constant", "s", 1.0, 300.0, 100.0, 1.0, 1e5}};
  found.suspects = {Named("autocollimator_drift", 0.0), creep};
  const Supposed supposed = LeftOpen(WithLessLikely(found), kTurntable)[1].hypothesis.causes.front();
  EXPECT_DOUBLE_EQ(supposed.parameters.at("amplitude"), 0.7 * units::arcsec);
  EXPECT_DOUBLE_EQ(supposed.finding.u.at("amplitude"), 0.1 * units::arcsec);
  EXPECT_DOUBLE_EQ(supposed.parameters.at("time_constant"), 300.0);
  const std::vector<Weighed> each = EachAlone(found, kTurntable, 0);
  ASSERT_EQ(each.size(), 2u);
  EXPECT_EQ(each[1].hypothesis.Name(), "mount_creep y");
  EXPECT_DOUBLE_EQ(each[1].hypothesis.causes.front().parameters.at("time_constant"), 300.0);
}

diagnose::ParameterEstimate Order(double order) {
  return {"order", "1", 1.0, order, 0.0, 1.0, 1e5};
}

// What was large was taken out first: alone, its rival would be something that the rest of the readings suggests.
TEST(Rival, OfALargeCauseBeginsWithTheOrderThatWasFitted) {
  diagnose::DiagnosisRun found;
  Cause fault{.effect = "reference_fault", .probability = 0.5, .indistinguishable_from = {{"periodic", ""}}};
  const Cause periodic{.effect = "periodic", .probability = 0.5, .parameters = {Order(4.0)},
                       .indistinguishable_from = {{"reference_fault", ""}}};
  found.diagnosis = {.verdict = diagnose::Verdict::kNamed, .causes = {periodic, fault}};
  fault.parameters = {Order(19.0)};
  found.suspects = {fault};
  const std::vector<Weighed> open = LeftOpen(found, PlainOf(kEncoderBench));
  ASSERT_EQ(open.size(), 2u);
  for (const Weighed& one : open) EXPECT_EQ(one.hypothesis.causes.front().parameters.at("order"), 4.0) << one.hypothesis.Name();
}

// A tilt with a lag: size and lag stand for each other, and the answer is "no name".
TEST(Unsized, StaysOpenBesideWhatHasNoName) {
  diagnose::DiagnosisRun found;
  found.diagnosis = {.verdict = diagnose::Verdict::kUnknown, .unknown = {0.9, ""}};
  EXPECT_DOUBLE_EQ(UnlistedBy(found), 0.9);
  found.unsized = {Named("mount_creep", 0.7)};
  EXPECT_NEAR(UnlistedBy(found), 0.9 * 0.3, 1e-12);
  const std::vector<Weighed> open = LeftOpen(found, kTurntable);
  ASSERT_EQ(open.size(), 2u);
  EXPECT_EQ(open[0].hypothesis.Name(), "mount_creep y");
  EXPECT_TRUE(open[1].hypothesis.IsNothing());
  EXPECT_NEAR(open[0].probability / open[1].probability, 0.7 / 0.1, 1e-9);
}

}  // namespace
}  // namespace twinbench::investigate
