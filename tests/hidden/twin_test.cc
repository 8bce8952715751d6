#include <gtest/gtest.h>

#include <set>

#include "tests/hidden/clean_cases.h"
#include "tests/hidden/reduced.h"
#include "tests/hidden/twin_cases.h"
#include "tests/hidden/unlisted.h"

// Cases that the twin makes: a sample of what hidden_score runs in full.
namespace twinbench::hidden {
namespace {

bool IsRight(const Outcome& o) {
  return o.RightOrTie() || o.grade == Grade::kUnknown || o.grade == Grade::kQuiet;
}
bool IsConfidentlyWrong(const Outcome& o) {
  return o.confident_wrong;
}
bool IsNotConfidentlyWrong(const Outcome& o) {
  return !o.confident_wrong;
}

/// One size a place: rho 20.
TwinOptions OneSize() {
  TwinOptions options;
  options.magnitudes = options.seeds = 1;
  options.rho_from = options.rho_to = 20.0;
  options.cache_folder = CacheFolder();
  return options;
}

/// Every `step`-th plan: neighbours are places of the same effect.
std::vector<Plan> EveryNth(const std::vector<Plan>& plans, std::size_t step, std::size_t first = 0) {
  std::vector<Plan> kept;
  for (std::size_t k = first; k < plans.size(); k += step) kept.push_back(plans[k]);
  return kept;
}

class Twin : public ::testing::TestWithParam<const char*> {};

TEST_P(Twin, EffectsOfTheCatalogueGetTheirNameOrATieThatHasIt) {
  const auto outcomes = RunReduced(EveryNth(SinglePlans(GetParam(), OneSize()), 2));
  EXPECT_TRUE(IsNotBelow(CountOf(outcomes, IsRight), outcomes.size(), 0.95)) << Others(outcomes, IsRight);
}

TEST_P(Twin, CleanRunsRaiseAlarmsInOneCaseOfAHundredWhateverTheirNoise) {
  const auto outcomes = RunReduced(CleanPlans(GetParam(), 3 * kNoises, 1));
  EXPECT_TRUE(IsNotBelow(CountOf(outcomes, IsRight), outcomes.size(), 0.99)) << Others(outcomes, IsRight);
}

TEST_P(Twin, CausesThatNoCatalogueListsAreUnknown) {
  const auto outcomes = RunReduced(UnlistedPlans(GetParam(), OneSize()));
  const auto is_unknown = [](const Outcome& o) { return o.verdict == diagnose::Verdict::kUnknown; };
  EXPECT_TRUE(IsNotBelow(CountOf(outcomes, is_unknown), outcomes.size(), 0.90)) << Others(outcomes, is_unknown);
  EXPECT_TRUE(IsNotAbove(CountOf(outcomes, IsConfidentlyWrong), outcomes.size(), 0.05))
      << Others(outcomes, IsNotConfidentlyWrong);
}

TEST_P(Twin, WithoutItsCauseTheCatalogueSeldomNamesAnother) {
  // Every design without an effect needs a calibration of its own, so this is a small sample.
  const auto outcomes = RunReduced(EveryNth(LeaveOneOutPlans(GetParam(), OneSize()), 6, 1));
  EXPECT_TRUE(IsNotAbove(CountOf(outcomes, IsConfidentlyWrong), outcomes.size(), 0.10))
      << Others(outcomes, IsNotConfidentlyWrong);
}

INSTANTIATE_TEST_SUITE_P(BothBenches, Twin, ::testing::Values(kRotaryBench, kEncoderBench),
                         [](const auto& of) { return std::string(of.param); });

TEST(HiddenCases, CoverEveryEffectOfBothCatalogues) {
  for (const std::string bench : {kRotaryBench, kEncoderBench}) {
    std::set<std::string> hidden;
    for (const Plan& plan : SinglePlans(bench, OneSize())) hidden.insert(plan.make().hidden.causes.at(0).effect);
    for (const EffectEntry& entry : EffectCatalogue(bench)) EXPECT_TRUE(hidden.contains(entry.name)) << entry.name;
  }
}

TEST(HiddenCases, AreTheSameForTheSameSeed) {
  const auto once = SinglePlans(kRotaryBench, OneSize()).front().make();
  const auto again = SinglePlans(kRotaryBench, OneSize()).front().make();
  ASSERT_EQ(once.readings.size(), again.readings.size());
  for (std::size_t i = 0; i < once.readings.size(); ++i) EXPECT_EQ(once.readings[i].mean_V, again.readings[i].mean_V);
}

}  // namespace
}  // namespace twinbench::hidden
