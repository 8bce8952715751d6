#include "twin/investigate/evidence.h"

#include <gtest/gtest.h>

#include "tests/hidden/bench_runs.h"
#include "tests/investigate/hidden_investigation.h"
#include "tools/twinbench/passing_run.h"
#include "twin/benches/registry.h"
#include "twin/core/units.h"

namespace twinbench::investigate {
namespace {

Scenario WithPlay() {
  Scenario hidden = hidden::Drawn(hidden::Design::kTurntable, 13001);
  EffectSettings play;
  play.name = "backlash";
  play.parameters["width"] = 0.27 * units::arcsec;
  hidden.effects.push_back(play);
  return hidden;
}

diagnose::Cause WithOdds(const std::string& effect, double probability) {
  diagnose::Cause cause;
  cause.effect = effect;
  cause.probability = probability;
  return cause;
}

/// A play, and a settling whose sizes the diagnosis did not state: it cannot be told from the play if it is slow.
diagnose::DiagnosisRun PlayRatherThanSettling() {
  diagnose::DiagnosisRun found;
  found.diagnosis.verdict = diagnose::Verdict::kNamed;
  found.diagnosis.causes = {WithOdds("backlash", 0.9), WithOdds("settling", 0.1)};
  found.diagnosis.causes.front().indistinguishable_from = {{"settling", ""}};
  found.diagnosis.causes.back().indistinguishable_from = {{"backlash", ""}};
  return found;
}

double ProbabilityOf(const Belief& belief, const std::string& name) {
  double probability = 0.0;
  for (const Open& open : belief.open) probability += open.fit.hypothesis.Name() == name ? open.probability : 0.0;
  return probability;
}

class Evidence : public testing::Test {
 protected:
  Evidence() {
    means_.diagnose = [](const auto&, const Scenario&, const auto&) { return diagnose::DiagnosisRun{}; };
    for (int k = 0; k < 2; ++k) {
      Scenario hidden = WithPlay();
      hidden.repeat = k;
      runs_.push_back(TakenOf({}, believed_, tools::ReadingsOfTwin(hidden), means_, k));
    }
  }

  const Scenario believed_ = hidden::Believed(hidden::Design::kTurntable);
  Means means_ = MeansOf(believed_);
  std::vector<TakenRun> runs_;
};

// A settling is fitted from a time of one second, and the first run leaves it at a few. Both runs lead to minutes,
// which is a play: they do so for the first run's readings too, and those were weighed already.
TEST_F(Evidence, OfSizesThatLaterRunsLeadToIsNotCountedTwice) {
  const std::vector<TakenRun> first = {runs_.front()};
  Belief belief = Begun(PlayRatherThanSettling(), first, means_);
  EXPECT_NEAR(ProbabilityOf(belief, "backlash"), 0.9, 1e-9);
  Update(belief, runs_, means_);
  EXPECT_GT(ProbabilityOf(belief, "backlash"), 0.7);
}

// Of what looks exactly like a cause, the catalogue lacks some: fits alone do not tell that from the cause.
TEST_F(Evidence, OfFitsAloneLeavesRoomForWhatTheCatalogueLacks) {
  diagnose::DiagnosisRun nothing;
  nothing.diagnosis.verdict = diagnose::Verdict::kNone;
  nothing.suspects = {WithOdds("backlash", 0.05)};
  Belief belief = Begun(nothing, {runs_.front()}, means_);
  Update(belief, runs_, means_);
  EXPECT_EQ(belief.Best().fit.hypothesis.Name(), "backlash");
  EXPECT_GT(belief.Best().probability, 0.99);
  NamedByFits(belief);
  EXPECT_NEAR(belief.Best().probability, 0.97, 0.01);
  EXPECT_NEAR(belief.unlisted, 0.03, 1e-12);
}

// Runs of one plan take each other's place - they are diagnosed together -, those of several plans count each.
TEST(Overtones, OfSeveralPlansCountTogetherAndUnseenOnesNotAtAll) {
  const double unseen = ProbabilityOfNoSine({{{}, 0.0}});
  EXPECT_GT(unseen, 0.1);
  EXPECT_LT(unseen, 0.5);
  EXPECT_NEAR(ProbabilityOfNoSine({{{"a=1"}, 0.02}, {{"a=2"}, 0.0}}), 0.02, 1e-12);
  EXPECT_LT(ProbabilityOfNoSine({{{"a=1"}, 0.02}, {{"a=2"}, 0.02}}), 0.005);
  EXPECT_NEAR(ProbabilityOfNoSine({{{"a=1"}, unseen}, {{"a=2"}, 0.9}}), 0.9, 1e-12);
  EXPECT_GT(ProbabilityOfNoSine({{{"a=1"}, 1.0}, {{"a=2"}, 0.02}}), 0.99);
}

}  // namespace
}  // namespace twinbench::investigate
