#include "twin/report/plan_text.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "twin/report/spoken_keys.h"

namespace twinbench::report {
namespace {

using ::testing::HasSubstr, ::testing::Not;

/// A run of one result of u 0.2, and a phase.
PlannedRun OneResult() {
  PlannedRun run{"as the scenario says", {}, {}};
  run.outlook.results = {{"equation_5.ez_arcsec", 36, 0.2, 0.3}, {"model.terms[].phase_deg", 2, 30.0, 40.0}};
  return run;
}

/// Nothing is looked at where no cause would be found.
PlannedEffects NoEffects() {
  PlannedEffects none;
  none.refused = "too few readings";
  return none;
}

TEST(PlanText, HasTheUncertaintyOfTheRunItsMeanAndThatAfterTheProgrammeBesideEachOther) {
  PlannedRun run = OneResult();
  run.mean = run.outlook;
  run.mean.results[0].rms_u = 0.25;
  run.mean_of = 9;
  PlannedProgramme programme;
  programme.gains = {{"equation_5.ez_arcsec", 0.5}};
  const std::string text = PlanText({run}, NoEffects(), {programme});
  EXPECT_THAT(text, HasSubstr("run 1  run 1, mean of 9  run 1 + programme\n"));
  EXPECT_THAT(text, HasSubstr("equation 5 of the paper (equation_5.ez_arcsec)    0.2              0.25                0.1\n"));
  EXPECT_THAT(text, HasSubstr("model.terms[].phase_deg                             -                 -                  -\n")) << "the run finds it";
  EXPECT_EQ(OutlookJson(run).at("results").at(0).at("mean_rms_u"), 0.25);
}

TEST(PlanText, HasTheRunAloneWhereNothingElseWasLookedAt) {
  const std::string text = PlanText({OneResult()}, NoEffects(), {});
  EXPECT_THAT(text, Not(HasSubstr("mean")));
  EXPECT_THAT(text, Not(HasSubstr("programme")));
  EXPECT_THAT(OutlookText(OneResult().outlook), HasSubstr("equation 5 of the paper (equation_5.ez_arcsec)      36               0.2      0.4\n")) << "as check says it";
}

TEST(WithWords, KeepsTheKeyInBracketsAndLeavesWhatNeedsNoWords) {
  EXPECT_EQ(WithWords("standard"), "errors of the reference standard (standard)");
  EXPECT_EQ(WithWords("multitooth"), "multi-tooth table (multitooth)");
  EXPECT_EQ(WithWords("separation.target.ez_arcsec"), "separation.target.ez_arcsec");
  EXPECT_EQ(WithWords("standards"), "standards");
}

}  // namespace
}  // namespace twinbench::report
