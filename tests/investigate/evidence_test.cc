#include <numbers>

#include "tests/investigate/hidden_investigation.h"
#include "tools/twinbench/passing_run.h"
#include "twin/benches/registry.h"
#include "twin/investigate/evidence.h"
#include "twin/investigate/expected_information.h"
#include "twin/investigate/taken_run.h"

namespace twinbench::investigate {
namespace {

Scenario WithPlay() {
  Scenario hidden = hidden::Drawn(hidden::Design::kTurntable, 13001);
  hidden.effects.push_back({"backlash", "", {{"width", 0.27 * units::arcsec}}, ""});
  return hidden;
}

diagnose::Cause WithOdds(const std::string& effect, double probability) {
  return {.effect = effect, .probability = probability};
}

/// A play, and a settling whose sizes the diagnosis did not state: it cannot be told from the play if it is slow.
diagnose::DiagnosisRun PlayRatherThanSettling() {
  diagnose::DiagnosisRun found;
  found.diagnosis = {.verdict = diagnose::Verdict::kNamed, .causes = {WithOdds("backlash", 0.9), WithOdds("settling", 0.1)}};
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

Expectation At(double probability, double mean, double spread = 0.0) {
  return {probability, Eigen::VectorXd::Constant(1, mean), Eigen::MatrixXd::Constant(1, 1, spread)};
}

double Normal(double x, double mean, double sd) {
  const double z = (x - mean) / sd;
  return std::exp(-0.5 * z * z) / (sd * std::sqrt(2.0 * std::numbers::pi));
}

/// Mutual information of two normal distributions in one dimension, by the trapezoidal rule.
double ByIntegral(double p, double mean_a, double sd_a, double mean_b, double sd_b) {
  double bits = 0.0;
  constexpr double kStep = 0.001, kNone = 1e-200;
  for (double x = -40.0; x < 40.0; x += kStep) {
    const double a = p * Normal(x, mean_a, sd_a), b = (1.0 - p) * Normal(x, mean_b, sd_b);
    if (a > kNone) bits += kStep * a * std::log2(a / (p * (a + b)));
    if (b > kNone) bits += kStep * b * std::log2(b / ((1.0 - p) * (a + b)));
  }
  return bits;
}

TEST(ExpectedInformation, IsNothingWhereAllShowTheSameAndTheWholeEntropyWhereTheyAreFarApart) {
  EXPECT_NEAR(ExpectedInformation_bit({At(0.5, 1.0), At(0.5, 1.0)}), 0.0, 1e-9);
  EXPECT_NEAR(ExpectedInformation_bit({At(0.7, 0.0), At(0.2, 30.0), At(0.1, 60.0)}), Entropy_bit({0.7, 0.2, 0.1}),
              1e-6);
}

TEST(ExpectedInformation, AgreesWithTheIntegral) {
  // 400 draws a hypothesis of a log ratio that scatters by about a bit: 0.05 bit.
  for (const double apart : {0.5, 1.0, 2.0, 3.0}) {
    EXPECT_NEAR(ExpectedInformation_bit({At(0.4, 0.0), At(0.6, apart)}), ByIntegral(0.4, 0.0, 1.0, apart, 1.0),
                0.05)
        << apart;
  }
  EXPECT_NEAR(ExpectedInformation_bit({At(0.5, 0.0), At(0.5, 2.0, 3.0)}),
              ByIntegral(0.5, 0.0, 1.0, 2.0, std::sqrt(10.0)), 0.05);
}

TEST(ExpectedInformation, IsSmallWhereTheRivalCanBeFittedToTheSame) {
  // Both sizes unknown along the direction in which they differ: the readings fit either.
  const double known = ExpectedInformation_bit({At(0.5, 0.0), At(0.5, 4.0)});
  const double unknown = ExpectedInformation_bit({At(0.5, 0.0, 40.0), At(0.5, 4.0, 40.0)});
  EXPECT_GT(known, 0.8);
  EXPECT_LT(unknown, 0.05);
}

// A run asks its own twin what another scenario leaves; a run that is built anew against that scenario, with slopes and
// a fit of its own, says the same.

void ExpectAsBuiltAnew(hidden::Design design, const EffectSettings& effect) {
  SCOPED_TRACE(effect.name);
  const Scenario believed = hidden::Believed(design);
  const Means means = MeansOf(believed);
  TakenRun run = TakenOf({}, believed, hidden::TakeReadings(hidden::Drawn(design, 5)), means, 0);
  ASSERT_TRUE(run.linear.left_by_another);
  const Hypothesis hypothesis{{{effect}}, {}, 0.0};
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
  const Supposed cause{{"settling", "", {{"amplitude", 1.0 * units::deg}, {"time_constant", 1000.0}}, ""}};
  EXPECT_EQ(LeftBy({{cause}, {}, 0.0}, run, means), run.left);
}

TEST(LeftByAScenario, IsWhatARunBuiltAnewLeaves) {
  ExpectAsBuiltAnew(hidden::Design::kRotary, {"psd_roll", "psd_a", {{"roll", 2e-3}}, ""});
  ExpectAsBuiltAnew(hidden::Design::kTurntable, {"autocollimator_scale", "", {{"gain_error", 0.02}}, ""});
}

}  // namespace
}  // namespace twinbench::investigate
