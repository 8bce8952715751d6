#include "tests/hidden/challenge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/hidden/known_wrong.h"
#include "tests/support/twin_run.h"
#include "twin/benches/names.h"

// The cases of the independent generators, whose shapes are those of no library of ours.
namespace twinbench::hidden {
namespace {

/// Every second case: all of them are in the scores.
std::vector<Plan> HalfOf(const char* bench) {
  const std::vector<Plan> all = ChallengePlans(test::DataPath(ChallengeSetOf(bench)), bench);
  std::vector<Plan> half;
  for (std::size_t k = 0; k < all.size(); k += 2) half.push_back(all[k]);
  return half;
}

/// Diagnosed once for all tests.
const std::vector<Outcome>& All() {
  static const std::vector<Outcome> outcomes = [] {
    std::vector<Plan> plans = HalfOf(kRotaryBench);
    for (const char* bench : {kEncoderBench, kCircularBench}) {
      const std::vector<Plan> more = ChallengePlans(test::DataPath(ChallengeSetOf(bench)), bench);
      plans.insert(plans.end(), more.begin(), more.end());
    }
    return RunReduced(plans);
  }();
  return outcomes;
}

TEST(Challenge, CasesAreAnsweredRightlyListedOrNotOrInOrder) {
  EXPECT_TRUE(WrongOnlyWhereKnown(AnsweredOf(All())));
  EXPECT_TRUE(IsPooledRate(CountOf(All(), IsRight), All().size(), 0.95, 0.75));
}

TEST(Challenge, NamesThatAreNotThereAreNotSure) {
  for (const Outcome& o : All()) EXPECT_FALSE(o.sure_wrong) << o.name << ": " << o.answer;
}

TEST(Challenge, NamedCausesPredictPassesThatWereNotUsed) {
  std::vector<Outcome> gained;
  std::ranges::copy_if(All(), std::back_inserter(gained),
                       [](const Outcome& o) { return o.RightOrTie() && std::isfinite(o.gain); });
  const auto enough = [](const Outcome& o) { return o.gain >= 0.9; };
  EXPECT_TRUE(IsPooledRate(CountOf(gained, enough), gained.size(), 0.9, 0.65)) << Others(gained, enough);
}

}  // namespace
}  // namespace twinbench::hidden
