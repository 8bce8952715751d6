#include "tests/hidden/challenge.h"

#include <gtest/gtest.h>

#include "tests/hidden/reduced.h"
#include "tests/support/twin_run.h"
#include "twin/benches/names.h"

// The cases of the independent generators, whose shapes are those of no library of ours.
namespace twinbench::hidden {
namespace {

bool IsListed(const Outcome& o) {
  return !o.hidden.causes.empty();
}
bool IsUnlisted(const Outcome& o) {
  return !o.hidden.unlisted.empty();
}
bool IsClean(const Outcome& o) {
  return o.hidden.IsClean();
}
class Challenge : public ::testing::TestWithParam<const char*> {
 protected:
  /// Diagnosed once for all tests of a bench.
  static const std::vector<Outcome>& Outcomes() {
    static std::map<std::string, std::vector<Outcome>> outcomes;
    std::vector<Outcome>& mine = outcomes[GetParam()];
    if (mine.empty()) mine = RunReduced(ChallengePlans(test::DataPath(ChallengeSetOf(GetParam())), GetParam()));
    return mine;
  }
  static std::vector<Outcome> Only(bool (*test)(const Outcome&)) {
    std::vector<Outcome> kept;
    std::ranges::copy_if(Outcomes(), std::back_inserter(kept), test);
    return kept;
  }
};

TEST_P(Challenge, ListedCausesGetTheirNameOrATieOfThreeThatHasIt) {
  const auto listed = Only(IsListed);
  EXPECT_TRUE(IsNotBelow(CountOf(listed, IsRight), listed.size(), 0.95)) << Others(listed, IsRight);
}

TEST_P(Challenge, UnlistedCausesAreUnknownWithTheirLockAndChannels) {
  const auto unlisted = Only(IsUnlisted);
  EXPECT_TRUE(IsNotBelow(CountOf(unlisted, IsRight), unlisted.size(), 0.90)) << Others(unlisted, IsRight);
}

TEST_P(Challenge, UnlistedCausesAreNeverNamedWithConfidence) {
  for (const Outcome& o : Only(IsUnlisted)) EXPECT_FALSE(o.confident_wrong) << o.name << ": " << o.answer;
}

TEST_P(Challenge, CleanRunsRaiseNoAlarm) {
  const auto clean = Only(IsClean);
  EXPECT_TRUE(IsNotBelow(CountOf(clean, IsRight), clean.size(), 0.99)) << Others(clean, IsRight);
}

TEST_P(Challenge, NamedCausesPredictPassesThatWereNotUsed) {
  std::vector<Outcome> gained = Only([](const Outcome& o) { return o.RightOrTie() && std::isfinite(o.gain); });
  const auto enough = [](const Outcome& o) { return o.gain >= 0.9; };
  EXPECT_TRUE(IsNotBelow(CountOf(gained, enough), gained.size(), 0.9)) << Others(gained, enough);
}

INSTANTIATE_TEST_SUITE_P(EveryBench, Challenge, ::testing::Values(kRotaryBench, kEncoderBench, kCircularBench),
                         [](const auto& of) { return std::string(of.param); });

}  // namespace
}  // namespace twinbench::hidden
