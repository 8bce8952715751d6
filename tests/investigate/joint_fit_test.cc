#include "twin/investigate/joint_fit.h"

#include "tests/investigate/hidden_investigation.h"
#include "tools/twinbench/passing_run.h"
#include "twin/investigate/evidence.h"

namespace twinbench::investigate {
namespace {

constexpr double kDeg = units::deg;

Scenario Small(const std::string& effect = "") {
  return ParseScenario(
      "bench = \"encoder_comparison\"\nseed = 4\n[device]\nnoise_deg = 0.002\n[encoder_procedure]\n"
      "stops_per_turn = 36\nstart_deg = 1.3\npasses = [1, -1]\nturns = 1.0\n" +
          effect,
      "small.toml", ".");
}

/// One cause, its sizes as free as before any reading.
Hypothesis Of(const std::string& name) {
  Hypothesis hypothesis;
  Supposed cause;
  cause.name = name;
  const EffectEntry entry = *FindEffect(name, "encoder_comparison");
  for (const EffectParameter& p : entry.parameters) {
    cause.parameters[p.name] = p.default_SI;
    cause.finding.u[p.name] = ThoughtOf(p, entry);
  }
  hypothesis.causes.push_back(cause);
  return hypothesis;
}

class JointFits : public testing::Test {
 protected:
  const Scenario believed_ = Small();
  const Means means_ = MeansOf(believed_);

  std::vector<TakenRun> RunsWith(const std::string& effect, int runs) {
    std::vector<TakenRun> taken;
    for (int k = 0; k < runs; ++k) {
      Scenario hidden = Small(effect);
      hidden.repeat = k;
      taken.push_back(TakenOf({}, believed_, tools::ReadingsOfTwin(hidden), means_, k));
    }
    return taken;
  }
  JointFit Fit(const std::string& name, const std::vector<TakenRun>& runs) {
    return FitJointly(Of(name), runs, means_);
  }
};

// What a diagnosis looks for up to some bound is called something else beyond it: no run may lead there.
TEST_F(JointFits, KeepACauseWhereTheDiagnosisCallsItSo) {
  const std::vector<TakenRun> runs = RunsWith("[[effect]]\nname = \"drift\"\nrate_deg_per_h = 2.0\n", 2);
  const double rate = 2.0 * kDeg / units::hour;
  Hypothesis steady = Of("drift"), slow;
  steady.causes.front().finding.u = {{"rate", 0.1 * rate}};
  slow = steady;
  slow.causes.front().within["rate"] = {0.0, 0.25 * rate};
  const JointFit free = FitJointly(steady, runs, means_), bounded = FitJointly(slow, runs, means_);
  EXPECT_GT(free.hypothesis.causes.front().parameters.at("rate"), 0.5 * rate);
  EXPECT_LE(bounded.hypothesis.causes.front().parameters.at("rate"), 0.25 * rate);
  EXPECT_LT(bounded.log_evidence, free.log_evidence);
}

TEST_F(JointFits, FindAWaveWhereverItBegins) {
  for (const double phase_deg : {20.0, 120.0, 200.0, 300.0}) {
    const auto runs = RunsWith(
        fmt::format("[[effect]]\nname = \"eccentricity\"\namplitude_deg = 0.004\nphase_deg = {}\n", phase_deg), 1);
    const EffectSettings found = Fit("eccentricity", runs).hypothesis.causes.front();
    const double amplitude = found.parameters.at("amplitude"), phase_rad = found.parameters.at("phase");
    // Of the two parts, each with 0.002 deg sqrt(2 / 72) = 0.00033 deg.
    EXPECT_NEAR(amplitude * std::cos(phase_rad) / kDeg, 0.004 * std::cos(phase_deg * kDeg), 0.0015) << phase_deg;
    EXPECT_NEAR(amplitude * std::sin(phase_rad) / kDeg, 0.004 * std::sin(phase_deg * kDeg), 0.0015) << phase_deg;
  }
}

// A hysteresis that settles at once is a play: what it leaves is the same, and it is as much less likely as
// travels of less than the distance of two stops were before. A fit of the fit says the same.
TEST_F(JointFits, WeighACauseThatContainsAnotherByTheRoomThatIsLeftToIt) {
  const auto runs = RunsWith("[[effect]]\nname = \"backlash\"\nwidth_deg = 0.02\n", 2);
  const JointFit play = Fit("backlash", runs), gradual = Fit("hysteresis", runs);
  EXPECT_NEAR(gradual.chi2, play.chi2, 3.0);
  const EffectSettings& found = gradual.hypothesis.causes.front();
  EXPECT_LT(found.parameters.at("settles_over"), 4.0 * kDeg);
  // exp(-10 deg / travel) of 20 sigma is seen in many stops: 1 to 5 deg of a breadth of 20 deg.
  EXPECT_GT(found.finding.u.at("settles_over"), 0.3 * kDeg);
  EXPECT_LT(found.finding.u.at("settles_over"), 6.0 * kDeg);
  EXPECT_LT(gradual.log_evidence, play.log_evidence - 0.7);
  EXPECT_GT(gradual.log_evidence, play.log_evidence - 5.0);
  EXPECT_NEAR(FitJointly(gradual.hypothesis, runs, means_).log_evidence, gradual.log_evidence, 1.0);
}

// A warming up in seconds is a peak between all the distances from its bound that are looked at. It was missed, its
// uncertainty became none, and in the next fit it was no size any more that costs anything.
TEST_F(JointFits, KeepWhatASizeCostsFromFitToFit) {
  const double rate = 1.2 * kDeg / units::hour, warm_up_s = 6.0;
  const auto runs = RunsWith("[[effect]]\nname = \"drift\"\nrate_deg_per_h = 1.2\nwarm_up_s = 6.0\n", 1);
  Hypothesis drift = Of("drift");
  drift.causes.front().parameters = {{"rate", rate}, {"warm_up", warm_up_s}, {"curvature", 0.0}};
  drift.causes.front().finding.u = {{"rate", 0.2 * rate}, {"warm_up", 0.3 * warm_up_s}};
  JointFit fit = FitJointly(drift, runs, means_);
  const double first = fit.log_evidence;
  for (int again = 0; again < 3; ++again) {
    fit = FitJointly(fit.hypothesis, runs, means_);
    EXPECT_GT(fit.hypothesis.causes.front().finding.u.at("warm_up"), 1.0) << again;
    EXPECT_NEAR(fit.log_evidence, first, 3.0) << again;
  }
}

// At nine tenths and a half of the amplitude most stops are cut, at the whole none is: one that cuts a few stops by
// three noise standard deviations lies in between, and no slope leads there from either.
TEST_F(JointFits, FindAClippingThatFewStopsAreNear) {
  constexpr double kLevel = 0.9975;
  const auto runs = RunsWith(fmt::format("[[effect]]\nname = \"signal_clipping\"\nlevel = {}\n", kLevel), 2);
  const JointFit clipped = Fit("signal_clipping", runs);
  EXPECT_NEAR(clipped.hypothesis.causes.front().parameters.at("level"), kLevel, 0.001);
  EXPECT_LT(clipped.chi2, 200.0);  // of 2 x 72 readings
}

TEST_F(JointFits, HoldASlipForOneOfItsRun) {
  auto runs = RunsWith("", 1);
  const auto slipped = RunsWith("[[effect]]\nname = \"slip\"\nstep_deg = 0.01\nat_reading = 30\n", 1);
  runs.insert(runs.begin(), slipped.front());
  runs[1].number = 1;
  Hypothesis slip = Of("slip");
  slip.causes.front().parameters["at_reading"] = 30.0;
  slip.causes.front().finding.u["at_reading"] = 2.0;
  const JointFit of_first = FitJointly(slip, runs, means_);
  EXPECT_NEAR(of_first.hypothesis.causes.front().parameters.at("step") / kDeg, 0.01, 0.002);
  EXPECT_LT(of_first.chi2, 200.0);  // of 2 x 72 readings
  slip.causes.front().happened_in = 1;
  EXPECT_GT(FitJointly(slip, runs, means_).chi2, of_first.chi2 + 100.0);
  EXPECT_EQ(slip.Name(), "slip in run 2");
}

// A wave of 0.01 deg in 72 readings of 0.002 deg is 30 standard deviations long: that something else had the same size
// by chance is 1 to 30. What nobody could have seen says nothing.
TEST_F(JointFits, HoldAMimicForAsUnlikelyAsItWouldHaveToHitTheSize) {
  const auto runs = RunsWith("[[effect]]\nname = \"eccentricity\"\namplitude_deg = 0.01\nphase_deg = 30\n", 1);
  const Hypothesis found = Fit("eccentricity", runs).hypothesis;
  EXPECT_NEAR(MimicFactor(found, runs.front(), means_), 1.0 / std::sqrt(1.0 + 25.0 * 36.0), 0.01);
  Hypothesis other = found;  // ten times as large as it is
  other.causes.front().parameters["amplitude"] *= 10.0;
  EXPECT_GT(MimicFactor(other, runs.front(), means_), 1e3);
  EXPECT_NEAR(MimicFactor({}, runs.front(), means_), 1.0, 1e-12);
}

TEST(Hypotheses, ShowWhatHappenedOnceInItsRunAndWhatItLeavesBehindLater) {
  Hypothesis slip = Of("slip");
  slip.causes.front().parameters["at_reading"] = 12.0;
  slip.causes.front().happened_in = 1;
  const Scenario scenario = Small();
  EXPECT_TRUE(With(scenario, slip, 0).effects.empty());
  EXPECT_EQ(With(scenario, slip, 1).effects.front().parameters.at("at_reading"), 12.0);
  EXPECT_EQ(With(scenario, slip, kToCome).effects.front().parameters.at("at_reading"), 0.0);
  Hypothesis other = slip;
  other.causes.front().happened_in = 0;
  EXPECT_FALSE(IsSame(slip, other));
}

}  // namespace
}  // namespace twinbench::investigate
