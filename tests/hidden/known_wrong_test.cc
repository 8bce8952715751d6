#include "tests/hidden/known_wrong.h"

#include <gmock/gmock.h>

#include "tests/core/input_error.h"
#include "tests/hidden/share.h"

// Whether the suite's own measures can fail.
namespace twinbench::hidden {
namespace {

using testing::HasSubstr;

std::string SaidBy(const ::testing::AssertionResult& result) {
  return result ? "" : result.message();
}

const std::vector<KnownWrong> kKnown = {{"twin", "b", "its tie has four members"}, {"other", "z", "not asked"}};

TEST(WrongOnlyWhereKnown, HoldsIfExactlyTheListedOnesAreWrong) {
  EXPECT_TRUE(WrongOnlyWhereKnown({{"twin", "a", true, ""}, {"twin", "b", false, ""}}, kKnown));
}

TEST(WrongOnlyWhereKnown, FailsWithACaseThatWasRight) {
  EXPECT_THAT(SaidBy(WrongOnlyWhereKnown({{"twin", "a", false, "hides x"}, {"twin", "b", false, ""}}, kKnown)),
              HasSubstr("wrong, and no known one:\n  twin | a hides x"));
}

TEST(WrongOnlyWhereKnown, WantsWhatHasBecomeRightOutOfTheList) {
  EXPECT_THAT(SaidBy(WrongOnlyWhereKnown({{"twin", "b", true, ""}}, kKnown)),
              HasSubstr("take them out of tests/data/known_wrong.txt\n  twin | b"));
}

TEST(WrongOnlyWhereKnown, WantsWhatIsNoCaseOutOfTheList) {
  EXPECT_THAT(SaidBy(WrongOnlyWhereKnown({{"twin", "a", true, ""}}, kKnown)),
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
TEST(PooledRate, CatchesATrueEightyFivePercentWhereNinetyFiveAreClaimed) {
  EXPECT_EQ(FewestOf(117, 0.85), 105);
  EXPECT_LT(ProbabilityToPass(117, 0.85, 0.85), 0.1);
  EXPECT_GT(ProbabilityToPass(117, 0.95, 0.85), 0.99);
  EXPECT_TRUE(IsPooledRate(105, 117, 0.95, 0.85));
  EXPECT_FALSE(IsPooledRate(104, 117, 0.95, 0.85));
}

TEST(PooledRate, RefusesTooFewCasesToTellOneRateFromTheOther) {
  EXPECT_THAT(SaidBy(IsPooledRate(20, 20, 0.95, 0.85)), HasSubstr("20 cases do not tell 0.95 from 0.85"));
  EXPECT_FALSE(IsPooledRate(0, 0, 0.95, 0.85));
}

// Of 100 at one half, P(X <= 36) = 0.0033 and P(X <= 37) = 0.0060.
TEST(ClaimedShare, FailsOnBothSides) {
  EXPECT_FALSE(IsShareOf(36, 100, 0.5));
  EXPECT_TRUE(IsShareOf(37, 100, 0.5));
  EXPECT_TRUE(IsShareOf(63, 100, 0.5));
  EXPECT_FALSE(IsShareOf(64, 100, 0.5));
}

}  // namespace
}  // namespace twinbench::hidden
