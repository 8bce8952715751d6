#include "twin/report/plan_text.h"
#include "twin/report/sound.h"
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

TEST(Sound, WhatIsNoNumberIsADash) {
  const std::pair<const char*, const char*> cases[] = {
      {"rms nan, largest  -nan um\n", "rms   -, largest     - µm\n"},
      {"lag 0.001 ± 1e+20 s", "lag    - s"},
      {"lag 1e22 ± 0.5 s, inf ms", "lag    - s,   - ms"},
      {"errs by 426381195756743.12 um", "errs by    - µm"},
      {"1.5 ± 0.2 um, order -1, 1e-20 of banana_inf", "1.5 ± 0.2 µm, order −1, 1e-20 of banana_inf"},
      {"x\n-3 (-2.5) at 2026-11-27, [-1 um, 1 um]", "x\n−3 (−2.5) at 2026-11-27, [−1 µm, 1 µm]"},
      {"passes = [1, -1], order = -2, then -2", "passes = [1, -1], order = -2, then −2"},
      {"noise  0.5 um  ∞  23.1 %", "noise  0.5 µm  ∞  23.1 %"},
      {"123456789.0 s", "123456789.0 s"}};
  for (const auto& [text, sound] : cases) EXPECT_EQ(WithoutNoNumbers(text), sound);
  EXPECT_EQ(WithoutNoNumbers("1,nan,-inf,2,um\n", ""), "1,,,2,um\n") << "a file";
}

TEST(Sound, AValueGoesWithItsUncertaintyAndAReasonStands) {
  Evaluation evaluation;
  evaluation.results = {{"a", {{"value", 3.0}, {"u", 1e20}, {"dof", 1e12}}}, {"x_um", {1.0, 2.0}}, {"u_x_um", {0.1, INFINITY}}, {"b", 4.0}};
  evaluation.summary = "a 3 ± 1e+20\n";
  Reading dark;
  dark.status = ReadingStatus::kNoLight;
  KeepSound({Reading{}, dark}, evaluation);
  nlohmann::json budget = {{{"u", 1.0}, {"U", 2e9}}};
  EXPECT_EQ(ClearNoNumbers(budget), 1);
  EXPECT_TRUE(budget[0]["U"].is_null());
  const nlohmann::json expected = {
      {"a", {{"value", nullptr}, {"u", nullptr}, {"dof", 1e12}}}, {"x_um", {1.0, nullptr}}, {"u_x_um", {0.1, nullptr}}, {"b", 4.0},
      {"not_determined", "the readings of this run do not determine it (of 2 readings 1 no_light)"}};
  EXPECT_EQ(evaluation.results, expected);
  EXPECT_EQ(evaluation.summary, "a -\n-: the readings of this run do not determine it (of 2 readings 1 no_light)\n");
}

TEST(Sound, AFitThatDoesNotDescribeItsReadingsHasNoUncertainty) {
  Evaluation good;
  good.results = {{"gain", {{"value", 3.0}, {"u", 0.1}}}, {"u_x_um", {0.1}}};
  good.separation = {{"x", 1.0}};
  good.summary = "12 readings\ngain 3.0 ± 0.1\n";
  good.misfits = {{"ccd", 4.9}, {"qpd", std::nan("")}};
  Evaluation bad = good;
  KeepSound({}, good);
  EXPECT_FALSE(good.IsRefuted());
  EXPECT_EQ(good.summary, "12 readings\ngain 3.0 ± 0.1\n");
  bad.misfits.push_back({"qpd_x", 5.1});
  KeepSound({}, bad);
  EXPECT_TRUE(bad.IsRefuted());
  EXPECT_FALSE(bad.Separated());
  EXPECT_TRUE(bad.results["gain"]["u"].is_null());
  EXPECT_EQ(bad.results["gain"]["value"], 3.0);
  EXPECT_EQ(bad.summary, "12 readings\nno result: " + bad.not_separated + "\n");
}

TEST(Sound, ASeparationOfWhichNothingIsDeterminedIsNone) {
  Evaluation some, none;
  some.separation = {{"target", {{"ez_arcsec", {1.0, INFINITY}}, {"u_ez_arcsec", {0.1, INFINITY}}}}};
  none.separation = {{"target", {{"ez_arcsec", {1.0, 2.0}}, {"u_ez_arcsec", {INFINITY, INFINITY}}}}};
  some.results = none.results = {{"readings", 20}};
  some.summary = none.summary = "20 readings\nez -\n";
  KeepSound({}, some);
  EXPECT_TRUE(some.Separated());
  KeepSound({}, none);
  EXPECT_TRUE(none.IsRefuted());
  EXPECT_FALSE(none.Separated());
  EXPECT_EQ(none.not_separated, "the readings determine none of the errors");
}

}  // namespace
}  // namespace twinbench::report
