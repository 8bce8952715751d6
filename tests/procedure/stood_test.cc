#include "twin/procedure/stood.h"

#include "tests/procedure/troubled_run.h"
#include "tests/support/kept_text.h"
#include "twin/procedure/step_proof.h"

/// Where tables stand while a reading is taken; whether what is shown goes as they go, tests/machine/proof_by_steps_test.cc asks.
namespace twinbench::procedure {
namespace {

using test::MemoryLog;

TEST(Stood, SaysHowFarOffItsStopAnAxisWasAndWhenUnlessNobodyLooked) {
  Stood x{.axis = "x", .is_rotary = false, .sent = 0.1, .before = 0.1 + 1e-6, .after = 0.1 - 3e-6, .tolerance = 4e-6};
  EXPECT_NEAR(x.Off(), 3e-6, 1e-15);
  EXPECT_NO_THROW(RequireStood(x));
  x.tolerance = 2e-6;
  EXPECT_EQ(test::KindOf([&] { RequireStood(x); }), FaultKind::kMoved) << "3 um are more than 2";
  EXPECT_KEPT(test::TextOf([&] { RequireStood(x); }));
  const Stood unknown{.axis = "target", .sent = 1.0, .tolerance = 1e-9};
  EXPECT_NO_THROW(RequireStood(unknown));
  Reading reading;
  EnterInto(reading, unknown);
  EXPECT_TRUE(reading.extra.empty());
}

/// The restless bench with a target that creeps away from block number `creeps_in` on, as often as it is said.
MemoryLog MeasuredWithACreepingTarget(int creeps_in, int times, double by_rad) {
  int blocks = 0;
  bool is_off = false;
  Course course;
  course.after = [&](const std::string& device, const std::string& request, CallAnswer& answer) {
    if (device == "adc") is_off = ++blocks >= creeps_in && blocks < creeps_in + times;
    if (request.starts_with("move") || device == "clock") is_off = false;
    if (!is_off || device != "target" || request != "state") return;
    const auto first = answer.text.find(' ') + 1, end = answer.text.find(' ', first);
    const double encoder_rad = std::stod(answer.text.substr(first, end - first));
    answer.text.replace(first, end - first, PrintInUnit(encoder_rad + by_rad, 1.0));
  };
  course.options.target.in_position_rad = course.options.reference.in_position_rad = 0.05 * units::arcsec;
  MemoryLog log;
  const std::string end = EndOnTwin(log, course);
  EXPECT_TRUE(end == "none" || end == "moved of target") << end;
  return log;
}

TEST(Stood, ATableThatCreepsWhileABlockIsTakenCostsAnAttemptAndNoBit) {
  const MemoryLog undisturbed = MeasuredWithACreepingTarget(1, 0, 0.0);
  const MemoryLog log = MeasuredWithACreepingTarget(7, 1, 0.06 * units::arcsec);
  EXPECT_EQ(test::TextOf(log.readings), test::TextOf(undisturbed.readings));
  ASSERT_EQ(log.attempts.size(), 1u);
  EXPECT_EQ(log.attempts[0].fault, "moved");
  EXPECT_EQ(log.attempts[0].reading, 6);
  EXPECT_KEPT(log.attempts[0].text);
  EXPECT_TRUE(undisturbed.attempts.empty());
}

TEST(Stood, ACreepThatIsAllowedIsInTheReading) {
  const MemoryLog log = MeasuredWithACreepingTarget(7, 1, 0.04 * units::arcsec);
  EXPECT_TRUE(log.attempts.empty());
  const auto shown_deg = [&](const char* column) { return std::stod(log.readings[6].extra.at(column)); };
  EXPECT_NEAR(3600.0 * (shown_deg("target_encoder_after_deg") - shown_deg("target_encoder_before_deg")), 0.04, 1e-6);
  EXPECT_EQ(log.readings[6].extra.size(), 4u);
}

TEST(RequireOnWay, AnAxisThatHasBeenSentIsBetweenBothEndsOfItsWayAndNotWhereItsZeroWas) {
  const auto is_on_way = [](double from, double to, double at, double took_s = 1.0) {
    const FaultKind expected = took_s < 1.0 ? FaultKind::kImplausible : FaultKind::kMoved;
    const auto kind = test::KindOf([&] { RequireOnWay({"x", true}, from, to, at, took_s); });
    EXPECT_EQ(kind.value_or(expected), expected);
    return !kind;
  };
  for (const double at : {0.9, 1.0, 1.5, 2.0, 2.1}) EXPECT_TRUE(is_on_way(1.0, 2.0, at)) << at;
  EXPECT_FALSE(is_on_way(1.0, 2.0, 0.0));
  EXPECT_FALSE(is_on_way(2.0, 1.0, 0.0));
  EXPECT_FALSE(is_on_way(2.0, 1.0, 3.0));
  EXPECT_TRUE(is_on_way(1.0, 1.0, 1.0));
  EXPECT_TRUE(is_on_way(1.0, 2.0, kNaN));
  constexpr double kShort_s = 0.01;  // in which the fastest turns by 0.63 rad
  EXPECT_TRUE(is_on_way(1.0, 0.0, 0.5, kShort_s));
  EXPECT_FALSE(is_on_way(1.0, 0.0, 0.0, kShort_s));  // it says that it has arrived
}

/// x goes by `x` where it should go by `should`, y by `y` where it should stand; no noise but a hundredth.
bool IsProved(StepProof& proof, double x, double y, double should = 1.0) {
  return !test::FaultOf([&] { proof.Require({{"x", should, x, 0.01}, {"y", 0.0, y, 0.01}}); });
}

TEST(StepProof, SignsAndGainsOfWiresAreWhatTheFirstStepSaysThatNeitherStandsNorIsExchanged) {
  StepProof proof(true);
  EXPECT_FALSE(IsProved(proof, 0.0, 0.0));
  EXPECT_FALSE(IsProved(proof, 0.0, 1.0));
  EXPECT_FALSE(IsProved(proof, 1e-3, 0.0));
  EXPECT_TRUE(IsProved(proof, -0.5, 0.1));
  EXPECT_TRUE(IsProved(proof, 0.5, -0.1, -1.0));  // the other way
  EXPECT_FALSE(IsProved(proof, 0.5, 0.1));
  EXPECT_FALSE(IsProved(proof, -1.0, 0.1));
}

TEST(StepProof, AFifthOfAStepTooMuchIsNothingAndHalfOfOneIsSomethingElse) {
  const auto is_proved = [](double x, double y, double back, bool is_of_size = true) {
    StepProof proof(false);
    return !test::FaultOf([&] { proof.Require({{"x", 1.0, x, 0.01, is_of_size, back}, {"y", 0.0, y, 0.01}}); });
  };
  EXPECT_TRUE(is_proved(1.2, 0.2, -0.2));
  EXPECT_FALSE(is_proved(0.5, 0.0, 0.0) || is_proved(1.0, 0.5, 0.0) || is_proved(1.0, 0.0, -0.5) || is_proved(kNaN, 0.0, 0.0) || is_proved(1.0, 0.0, kNaN));
  EXPECT_TRUE(is_proved(-0.1, 0.0, 0.0, false)) << "noise of 0.01 hides a sign of so much";
  EXPECT_FALSE(is_proved(-0.2, 0.0, 0.0, false));
}

TEST(StepProof, OfColumnsWhoseSizeNobodyKnowsOneOrTheOtherGoesUnlessTheAxesStand) {
  const auto is_proved = [](double x, double y, double should) {
    StepProof proof(false);
    return !test::FaultOf([&] { proof.Require({{"x", should, x, 0.01, false}, {"y", -should, y, 0.01, false}}); });
  };
  EXPECT_TRUE(is_proved(0.0, -0.5, 2.0)) << "x may be at the end of its range";
  EXPECT_FALSE(is_proved(0.1, 0.1, 2.0) || is_proved(0.002, -0.002, 2.0));
  EXPECT_TRUE(is_proved(0.002, -0.002, 1.0)) << "it may go less than noise";
}

}  // namespace
}  // namespace twinbench::procedure
