#include "twin/diagnose/stated_outliers.h"

#include <gtest/gtest.h>

#include "tests/diagnose/found_causes.h"

namespace twinbench::diagnose {
namespace {

/// A run of 1000 readings in which `fraction` of them was found far outside.
DiagnosisRun FoundOutliers(double fraction, double size_m) {
  Cause cause = test::FoundCause("outliers", "", {"fraction", "1", 1.0, fraction, 0.002, 0.0, 0.5});
  cause.parameters.push_back({"size", "um", 1e-6, size_m, 1e-7, 0.0, 1.0});
  DiagnosisRun run = test::NamedRun(cause);
  run.diagnosis.readings = 1000;
  run.diagnosis.alarm_p = 1e-9;
  run.structure_p = 0.4;
  return run;
}

Scenario Stating(double fraction, double size_m) {
  Scenario scenario;
  EffectSettings outliers;
  outliers.name = "outliers";
  outliers.parameters = {{"fraction", fraction}, {"size", size_m}};
  scenario.effects = {outliers};
  return scenario;
}

TEST(StatedOutliers, AreNoCause) {
  DiagnosisRun run = FoundOutliers(0.012, 2e-6);
  LeaveOutStatedOutliers(Stating(0.01, 2e-6), run);
  EXPECT_TRUE(run.diagnosis.causes.empty());
  EXPECT_EQ(run.diagnosis.verdict, Verdict::kNone);
  EXPECT_EQ(run.diagnosis.alarm_p, 0.4);
  EXPECT_EQ(run.diagnosis.noise.size(), 1u);
}

TEST(StatedOutliers, ThatAreMoreOrLargerAreStillOne) {
  for (const auto& [fraction, size_m] : {std::pair{0.03, 2e-6}, std::pair{0.01, 20e-6}}) {
    DiagnosisRun run = FoundOutliers(fraction, size_m);
    LeaveOutStatedOutliers(Stating(0.01, 2e-6), run);
    EXPECT_EQ(run.diagnosis.causes.size(), 1u);
    EXPECT_EQ(run.diagnosis.alarm_p, 1e-9);
  }
}

TEST(StatedOutliers, WithoutAStatementAreOne) {
  DiagnosisRun run = FoundOutliers(0.01, 2e-6);
  LeaveOutStatedOutliers(Scenario{}, run);
  EXPECT_EQ(run.diagnosis.verdict, Verdict::kNamed);
}

}  // namespace
}  // namespace twinbench::diagnose
