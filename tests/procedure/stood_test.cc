#include "twin/procedure/stood.h"

#include <gtest/gtest.h>

#include "tests/procedure/troubled_run.h"
#include "tests/support/kept_text.h"
#include "twin/core/device_fault.h"
#include "twin/core/number_text.h"
#include "twin/core/units.h"
#include "twin/procedure/step_proof.h"

/// Where tables stand while a reading is taken, and whether what is shown goes as they go.
namespace twinbench::procedure {
namespace {

using test::MemoryLog;

TEST(Stood, SaysHowFarOffItsStopAnAxisWasAndWhen) {
  Stood x{.axis = "x", .is_rotary = false, .sent = 0.1, .before = 0.1 + 1e-6, .after = 0.1 - 3e-6, .tolerance = 4e-6};
  EXPECT_NEAR(x.Off(), 3e-6, 1e-15);
  EXPECT_NO_THROW(RequireStood(x));
  x.tolerance = 2e-6;
  try {
    RequireStood(x);
    FAIL() << "3 um are more than 2";
  } catch (const DeviceFault& fault) {
    EXPECT_EQ(fault.kind(), FaultKind::kMoved);
    EXPECT_KEPT(fault.what());
  }
}

TEST(Stood, WhatNobodyLookedAtIsNeitherEnteredNorWrong) {
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

TEST(Stood, ATableThatGoesOnCreepingEndsTheRun) {
  const MemoryLog log = MeasuredWithACreepingTarget(7, 100, 0.06 * units::arcsec);
  EXPECT_EQ(log.readings.size(), 6u);
  EXPECT_EQ(log.attempts.size(), 3u);
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
    try {
      RequireOnWay({"x", true}, from, to, at, took_s);
    } catch (const DeviceFault& fault) {
      EXPECT_EQ(fault.kind(), took_s < 1.0 ? FaultKind::kImplausible : FaultKind::kMoved);
      return false;
    }
    return true;
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

/// x goes by `x` where it should go by 1, y by `y` where it should stand; no noise but a hundredth.
std::vector<ColumnInStep> Went(double x, double y, double should = 1.0) {
  return {{"x", should, x, 0.01}, {"y", 0.0, y, 0.01}};
}

bool IsProved(StepProof& proof, const std::vector<ColumnInStep>& columns) {
  try {
    proof.Require(columns);
  } catch (const DeviceFault& fault) {
    EXPECT_EQ(fault.kind(), FaultKind::kMoved);
    return false;
  }
  return true;
}

TEST(StepProof, WhatIsShownGoesAsFarAsItShouldAndNothingElseGoes) {
  StepProof proof(false);
  EXPECT_TRUE(IsProved(proof, Went(1.2, 0.2)));
  EXPECT_FALSE(IsProved(proof, Went(0.0, 0.0)));  // it stands
  EXPECT_FALSE(IsProved(proof, Went(-1.0, 0.0)));
  EXPECT_FALSE(IsProved(proof, Went(0.0, 1.0)));  // channels are exchanged
  EXPECT_FALSE(IsProved(proof, Went(1e-3, 0.0)));
  EXPECT_FALSE(IsProved(proof, Went(206.0 / 1000.0, 0.0)));  // microradians for arc seconds
  EXPECT_FALSE(IsProved(proof, Went(kNaN, 0.0)));
  EXPECT_TRUE(IsProved(proof, Went(1.0, 0.0)));
}

TEST(StepProof, SignsAndGainsOfWiresAreWhatTheFirstStepSaysThatNeitherStandsNorIsExchanged) {
  StepProof proof(true);
  EXPECT_FALSE(IsProved(proof, Went(0.0, 0.0)));
  EXPECT_FALSE(IsProved(proof, Went(0.0, 1.0)));
  EXPECT_FALSE(IsProved(proof, Went(1e-3, 0.0)));
  EXPECT_TRUE(IsProved(proof, Went(-0.5, 0.1)));
  EXPECT_TRUE(IsProved(proof, Went(0.5, -0.1, -1.0)));  // the other way
  EXPECT_FALSE(IsProved(proof, Went(0.5, 0.1)));
  EXPECT_FALSE(IsProved(proof, Went(-1.0, 0.1)));
}

TEST(StepProof, BehindComingBackAllIsShownAsBefore) {
  StepProof proof(false);
  const auto came_back = [](double off) { return std::vector<ColumnInStep>{{"x", 1.0, 1.0, 0.01, true, off}, {"y", 0.0, 0.0, 0.01}}; };
  EXPECT_TRUE(IsProved(proof, came_back(0.3)));
  EXPECT_FALSE(IsProved(proof, came_back(1.0)));
  EXPECT_FALSE(IsProved(proof, came_back(-0.5)));
  EXPECT_FALSE(IsProved(proof, came_back(kNaN)));
}

TEST(StepProof, OfASizeThatNobodyKnowsTheSignIsSureWhereNoiseLeavesIt) {
  StepProof proof(false);
  const auto went = [](double did) { return std::vector<ColumnInStep>{{"x", 1.0, did, 0.01, false}}; };
  EXPECT_TRUE(IsProved(proof, went(20.0)));
  EXPECT_TRUE(IsProved(proof, went(-0.1)));
  EXPECT_FALSE(IsProved(proof, went(-0.2)));
}

}  // namespace
}  // namespace twinbench::procedure
