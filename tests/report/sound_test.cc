#include "twin/report/sound.h"

#include <gtest/gtest.h>

#include <utility>

namespace twinbench::report {
namespace {

TEST(Sound, WhatIsNoNumberIsADash) {
  const std::pair<const char*, const char*> cases[] = {
      {"rms nan, largest  -nan um\n", "rms   -, largest     - µm\n"},
      {"lag 0.001 ± 1e+20 s", "lag    - s"},
      {"lag 1e22 ± 0.5 s, inf ms", "lag    - s,   - ms"},
      {"errs by 426381195756743.12 um", "errs by    - µm"},
      {"1.5 ± 0.2 um, order -1, 1e-20 of banana_inf", "1.5 ± 0.2 µm, order −1, 1e-20 of banana_inf"},
      {"x\n-3 (-2.5) at 2026-11-27, [-1 um, 1 um]", "x\n−3 (−2.5) at 2026-11-27, [−1 µm, 1 µm]"},
      {"passes = [1, -1], order = -2, then -2", "passes = [1, -1], order = -2, then −2"},
      {"inf degrees of freedom", "inf degrees of freedom"},
      {"noise  0.5 um  inf  23.1 %", "noise  0.5 µm  inf  23.1 %"},
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

}  // namespace
}  // namespace twinbench::report
