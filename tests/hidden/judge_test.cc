#include "tests/core/input_error.h"
#include "tests/hidden/known_wrong.h"

namespace twinbench::hidden {
namespace {

using diagnose::Diagnosis, diagnose::Verdict;
using testing::HasSubstr;

// The marks themselves: a score is worth what its marks are.

Hidden Listed(const std::string& effect, const std::string& where = "") {
  return {.causes = {{effect, where, {{"size", 2.0}}}}};
}

Diagnosis Answer(Verdict verdict, const std::vector<std::array<std::string, 2>>& causes,
                 double probability = 0.95) {
  Diagnosis d;
  d.verdict = verdict;
  for (const auto& [effect, where] : causes) {
    d.causes.push_back({.effect = effect, .where = where, .probability = probability});
  }
  return d;
}

Diagnosis AnswerUnknown(const std::string& signature) {
  return {.verdict = Verdict::kUnknown, .unknown = {0.9, signature}};
}

Diagnosis Named(const std::vector<std::array<std::string, 2>>& causes, double probability = 0.95) {
  return Answer(Verdict::kNamed, causes, probability);
}

TEST(Judge, ANameIsRightOnlyWithItsPlaceAndATieCountsUpToThreeMembers) {
  const Hidden gain = Listed("psd_gain", "psd_a_x"), slip = Listed("slip", "yaw");
  EXPECT_EQ(Judge(gain, Named({{"psd_gain", "psd_a_x"}})).grade, Grade::kRight);
  EXPECT_EQ(Judge(gain, Named({{"psd_gain", "psd_a_y"}})).grade, Grade::kWrong);
  EXPECT_EQ(Judge(gain, Named({{"psd_gain", "psd_a_x"}, {"tone", "all"}})).grade, Grade::kRightAndMore);
  EXPECT_EQ(Judge(Listed("backlash"), Named({{"backlash", "target"}})).grade, Grade::kRight);
  EXPECT_EQ(Judge(slip, Answer(Verdict::kTie, {{"tone", "yaw"}, {"slip", "yaw"}})).grade, Grade::kTie);
  EXPECT_EQ(Judge(slip, Answer(Verdict::kTie, {{"tone", "yaw"}, {"slip", "yaw"}, {"a", ""}, {"b", ""}})).grade,
            Grade::kLargeTie);
}

TEST(Judge, WrongNamesAreSureFromEightTenthsUnlessNothingTellsThemFromTheTruth) {
  Hidden hidden = Listed("psd_distance", "psd_a");
  EXPECT_TRUE(Judge(hidden, Named({{"tone", "all"}}, 0.8)).sure_wrong);
  EXPECT_FALSE(Judge(hidden, Named({{"tone", "all"}}, 0.79)).sure_wrong);
  EXPECT_FALSE(Judge(hidden, Named({{"psd_distance", "psd_a"}}, 0.97)).sure_wrong);
  EXPECT_TRUE(Judge({}, Named({{"tone", "all"}})).sure_wrong);
  hidden.alike = {"psd_distance", "tone"};
  EXPECT_FALSE(Judge(hidden, Named({{"tone", "all"}}, 0.9)).sure_wrong);
}

TEST(Judge, AnUnknownNeedsItsLockAndExactlyItsChannels) {
  Hidden hidden{.unlisted = "etalon", .locks = {"spot"}, .channels = {"psd_b_x"}};
  const std::pair<const char*, Grade> signatures[] = {
      {"periodic, synchronous with spot, on psd_b_x", Grade::kUnknown},
      {"wander | periodic, synchronous with spot, on psd_b_x", Grade::kUnknown},
      {"periodic, synchronous with spot, on psd_b_y", Grade::kUnknownMisplaced},
      {"periodic, synchronous with spot, on psd_b_y; or the same on psd_a_x, psd_b_x", Grade::kUnknown},
      {"slow wander, function of time, on psd_b_x", Grade::kUnknownMisplaced}};
  for (const auto& [signature, grade] : signatures)
    EXPECT_EQ(Judge(hidden, AnswerUnknown(signature)).grade, grade) << signature;
  EXPECT_EQ(Judge(hidden, Named({{"tone", "psd_b_x"}})).grade, Grade::kWrong);
}

TEST(Judge, SizesAreComparedWithTheirTruthAndPhasesModuloAFullTurn) {
  const auto compared = [](const std::string& name, double truth, double value, double u) {
    Hidden hidden = Listed("tone");
    hidden.causes[0].parameters = {{name, truth}};
    Diagnosis d = Named({{"tone", "all"}});
    d.causes[0].parameters = {{name, "1", 1.0, value, u}};
    return Judge(hidden, d).parameters.at(0);
  };
  EXPECT_FALSE(compared("size", 2.0, 2.3, 0.1).Covers());
  EXPECT_TRUE(compared("size", 2.0, 2.3, 0.2).Covers());
  EXPECT_NEAR(compared("phase", 0.05, 2.0 * units::kPi - 0.05, 0.06).Error(), -0.1, 1e-12);
  EXPECT_TRUE(compared("phase", 0.05, 2.0 * units::kPi - 0.05, 0.06).Covers());
  EXPECT_FALSE(compared("phase", 0.05, 2.0 * units::kPi - 0.05, 0.05).Covers());
}

TEST(Share, HasTheIntervalOfClopperAndPearson) {
  // Closed forms for none and all of 10: 1 - 0.025^(1/10).
  EXPECT_NEAR((Share{0, 10}.Interval95()[1]), 1.0 - std::pow(0.025, 0.1), 1e-9);
  EXPECT_NEAR((Share{10, 10}.Interval95()[0]), std::pow(0.025, 0.1), 1e-9);
  EXPECT_NEAR(ProbabilityOfAtMost(1, 3, 0.5), 0.5, 1e-12);
}

// Whether the suite's own measures can fail.

std::string SaidBy(const ::testing::AssertionResult& result) { return result ? "" : result.message(); }

const std::vector<KnownWrong> kKnown = {{"twin", "b", "its tie has four members"}, {"other", "z", "not asked"}};

TEST(WrongOnlyWhereKnown, HoldsIfExactlyTheListedOnesAreWrongAndWantsTheOthersOutOfTheList) {
  const auto said_of = [](const std::vector<Answered>& answered) {
    return SaidBy(WrongOnlyWhereKnown(answered, kKnown));
  };
  EXPECT_EQ(said_of({{"twin", "a", true, ""}, {"twin", "b", false, ""}}), "");
  EXPECT_THAT(said_of({{"twin", "a", false, "hides x"}, {"twin", "b", false, ""}}),
              HasSubstr("wrong, and no known one:\n  twin | a hides x"));
  EXPECT_THAT(said_of({{"twin", "b", true, ""}}),
              HasSubstr("take them out of tests/data/known_wrong.txt\n  twin | b"));
  EXPECT_THAT(said_of({{"twin", "a", true, ""}}),
              HasSubstr("no case any more: take them out of tests/data/known_wrong.txt\n  twin | b"));
}

TEST(KnownWrongCases, NeedTheirReason) {
  EXPECT_EQ(ParseKnownWrong("# words\n\ntwin x | rotary:a:b:1 | a reason | more\n", "f").at(0).why,
            "a reason | more");
  EXPECT_THROW(ParseKnownWrong("twin x | rotary:a:b:1 |\n", "f"), InputError);
  for (const KnownWrong& known : KnownWrongCases()) EXPECT_GT(known.why.size(), 20u) << known.name;
}

double ProbabilityToPass(int of, double true_rate, double caught) {
  return 1.0 - ProbabilityOfAtMost(FewestOf(of, caught) - 1, of, true_rate);
}

// Of 117 effects: the binomial's figures, by hand 105 of 117.
TEST(PooledRate, CatchesATrueEightyFivePercentWhereNinetyFiveAreClaimedAndRefusesTooFewCasesToTellThem) {
  EXPECT_EQ(FewestOf(117, 0.85), 105);
  EXPECT_LT(ProbabilityToPass(117, 0.85, 0.85), 0.1);
  EXPECT_GT(ProbabilityToPass(117, 0.95, 0.85), 0.99);
  EXPECT_TRUE(IsPooledRate(105, 117, 0.95, 0.85));
  EXPECT_FALSE(IsPooledRate(104, 117, 0.95, 0.85));
  EXPECT_THAT(SaidBy(IsPooledRate(20, 20, 0.95, 0.85)), HasSubstr("20 cases do not tell 0.95 from 0.85"));
  EXPECT_FALSE(IsPooledRate(0, 0, 0.95, 0.85));
}

// Of 100 at one half, P(X <= 36) = 0.0033 and P(X <= 37) = 0.0060.
TEST(ClaimedShare, FailsOnBothSides) {
  for (const int count : {36, 37, 63, 64}) EXPECT_EQ(bool(IsShareOf(count, 100, 0.5)), 36 < count && count < 64);
}

}  // namespace
}  // namespace twinbench::hidden
