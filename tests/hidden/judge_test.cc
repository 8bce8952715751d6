#include "tests/hidden/judge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/hidden/share.h"

// The marks themselves: a score is worth what its marks are.
namespace twinbench::hidden {
namespace {

using diagnose::Diagnosis;
using diagnose::Verdict;

Hidden Listed(const std::string& effect, const std::string& where = "") {
  Hidden hidden;
  hidden.causes = {{effect, where, {{"size", 2.0}}}};
  return hidden;
}

Diagnosis Answer(Verdict verdict, const std::vector<std::array<std::string, 2>>& causes,
                 double probability = 0.95) {
  Diagnosis d;
  d.verdict = verdict;
  for (const auto& [effect, where] : causes) {
    diagnose::Cause cause;
    cause.effect = effect;
    cause.where = where;
    cause.probability = probability;
    d.causes.push_back(cause);
  }
  return d;
}

Diagnosis AnswerUnknown(const std::string& signature) {
  Diagnosis d;
  d.verdict = Verdict::kUnknown;
  d.unknown = {0.9, signature};
  return d;
}

TEST(Judge, ANameIsRightOnlyWithItsPlace) {
  const Hidden hidden = Listed("psd_gain", "psd_a_x");
  EXPECT_EQ(Judge(hidden, Answer(Verdict::kNamed, {{"psd_gain", "psd_a_x"}})).grade, Grade::kRight);
  EXPECT_EQ(Judge(hidden, Answer(Verdict::kNamed, {{"psd_gain", "psd_a_y"}})).grade, Grade::kWrong);
  EXPECT_EQ(Judge(hidden, Answer(Verdict::kNamed, {{"psd_gain", "psd_a_x"}, {"tone", "all"}})).grade,
            Grade::kRightAndMore);
  EXPECT_EQ(Judge(Listed("backlash"), Answer(Verdict::kNamed, {{"backlash", "target"}})).grade, Grade::kRight);
}

TEST(Judge, ATieCountsUpToThreeMembers) {
  const Hidden hidden = Listed("slip", "yaw");
  EXPECT_EQ(Judge(hidden, Answer(Verdict::kTie, {{"tone", "yaw"}, {"slip", "yaw"}})).grade, Grade::kTie);
  EXPECT_EQ(Judge(hidden, Answer(Verdict::kTie, {{"tone", "yaw"}, {"slip", "yaw"}, {"a", ""}, {"b", ""}})).grade,
            Grade::kLargeTie);
}

TEST(Judge, WrongNamesAreSureFromEightTenthsUnlessNothingTellsThemFromTheTruth) {
  Hidden hidden = Listed("psd_distance", "psd_a");
  EXPECT_TRUE(Judge(hidden, Answer(Verdict::kNamed, {{"tone", "all"}}, 0.8)).sure_wrong);
  EXPECT_FALSE(Judge(hidden, Answer(Verdict::kNamed, {{"tone", "all"}}, 0.79)).sure_wrong);
  EXPECT_FALSE(Judge(hidden, Answer(Verdict::kNamed, {{"psd_distance", "psd_a"}}, 0.97)).sure_wrong);
  EXPECT_TRUE(Judge({}, Answer(Verdict::kNamed, {{"tone", "all"}})).sure_wrong);
  hidden.alike = {"psd_distance", "tone"};
  EXPECT_FALSE(Judge(hidden, Answer(Verdict::kNamed, {{"tone", "all"}}, 0.9)).sure_wrong);
}

TEST(Judge, AnUnknownNeedsItsLockAndExactlyItsChannels) {
  Hidden hidden;
  hidden.unlisted = "etalon";
  hidden.locks = {"spot"};
  hidden.channels = {"psd_b_x"};
  EXPECT_EQ(Judge(hidden, AnswerUnknown("periodic, locked to spot, on psd_b_x")).grade, Grade::kUnknown);
  EXPECT_EQ(Judge(hidden, AnswerUnknown("wander | periodic, locked to spot, on psd_b_x")).grade, Grade::kUnknown);
  EXPECT_EQ(Judge(hidden, AnswerUnknown("periodic, locked to spot, on psd_b_y")).grade, Grade::kUnknownMisplaced);
  EXPECT_EQ(
      Judge(hidden, AnswerUnknown("periodic, locked to spot, on psd_b_y; or the same on psd_a_x, psd_b_x")).grade,
      Grade::kUnknown);
  EXPECT_EQ(Judge(hidden, AnswerUnknown("slow wander locked to time, on psd_b_x")).grade, Grade::kUnknownMisplaced);
  EXPECT_EQ(Judge(hidden, Answer(Verdict::kNamed, {{"tone", "psd_b_x"}})).grade, Grade::kWrong);
}

TEST(Judge, SizesAreComparedWithTheirTruth) {
  Diagnosis d = Answer(Verdict::kNamed, {{"tone", "all"}});
  d.causes[0].parameters = {{"size", "1", 1.0, 2.3, 0.1}};
  EXPECT_FALSE(Judge(Listed("tone"), d).parameters.at(0).Covers());
  d.causes[0].parameters[0].u = 0.2;
  EXPECT_TRUE(Judge(Listed("tone"), d).parameters.at(0).Covers());
}

TEST(Judge, PhasesAreComparedModuloAFullTurn) {
  Hidden hidden = Listed("tone");
  hidden.causes[0].parameters = {{"phase", 0.05}};
  Diagnosis d = Answer(Verdict::kNamed, {{"tone", "all"}});
  d.causes[0].parameters = {{"phase", "deg", units::deg, 2.0 * units::kPi - 0.05, 0.06}};
  EXPECT_NEAR(Judge(hidden, d).parameters.at(0).Error(), -0.1, 1e-12);
  EXPECT_TRUE(Judge(hidden, d).parameters.at(0).Covers());
  d.causes[0].parameters[0].u = 0.05;
  EXPECT_FALSE(Judge(hidden, d).parameters.at(0).Covers());
}

TEST(Share, HasTheIntervalOfClopperAndPearson) {
  // Closed forms for none and all of 10: 1 - 0.025^(1/10).
  EXPECT_NEAR((Share{0, 10}.Interval95()[1]), 1.0 - std::pow(0.025, 0.1), 1e-9);
  EXPECT_NEAR((Share{10, 10}.Interval95()[0]), std::pow(0.025, 0.1), 1e-9);
  EXPECT_NEAR(ProbabilityOfAtMost(1, 3, 0.5), 0.5, 1e-12);
}

}  // namespace
}  // namespace twinbench::hidden
