#include <gtest/gtest.h>

#include "twin/benches/names.h"
#include "twin/core/units.h"
#include "twin/investigate/hypothesis.h"

namespace twinbench::investigate {
namespace {

using diagnose::Cause;

Cause Named(const std::string& effect, double probability) {
  Cause cause;
  cause.effect = effect;
  cause.where = "y";
  cause.probability = probability;
  return cause;
}

/// A drift that the answer names, beside a creep that it is too sure of to list.
diagnose::DiagnosisRun DriftFound() {
  diagnose::DiagnosisRun found;
  found.diagnosis.verdict = diagnose::Verdict::kNamed;
  found.diagnosis.causes = {Named("autocollimator_drift", 0.85)};
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

TEST(LessLikely, OfACauseThatIsNoLongerToldIsLeftOut) {
  diagnose::DiagnosisRun found = DriftFound();
  found.diagnosis.causes = {Named("tone", 0.9)};
  EXPECT_EQ(WithLessLikely(found).diagnosis.causes.size(), 1u);
}

TEST(LessLikely, ThatTheAnswerListsIsNotListedTwice) {
  diagnose::DiagnosisRun found = DriftFound();
  found.diagnosis.causes.push_back(Named("mount_creep", 0.4));
  EXPECT_EQ(WithLessLikely(found).diagnosis.causes.size(), 2u);
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
  found.diagnosis.verdict = diagnose::Verdict::kNamed;
  Cause periodic = Named("periodic", 0.5), fault = Named("reference_fault", 0.5);
  periodic.where = fault.where = "";
  periodic.parameters = {Order(4.0)};
  fault.indistinguishable_from = {{"periodic", ""}};
  periodic.indistinguishable_from = {{"reference_fault", ""}};
  found.diagnosis.causes = {periodic, fault};
  Cause alone = fault;
  alone.parameters = {Order(19.0)};
  found.suspects = {alone};
  const std::vector<Weighed> open = LeftOpen(found, PlainOf(kEncoderBench));
  ASSERT_EQ(open.size(), 2u);
  for (const Weighed& one : open) EXPECT_EQ(one.hypothesis.causes.front().parameters.at("order"), 4.0) << one.hypothesis.Name();
}

// A tilt with a lag: size and lag stand for each other, and the answer is "no name".
TEST(Unsized, StaysOpenBesideWhatHasNoName) {
  diagnose::DiagnosisRun found;
  found.diagnosis.verdict = diagnose::Verdict::kUnknown;
  found.diagnosis.unknown.probability = 0.9;
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
