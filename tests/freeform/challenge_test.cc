#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/freeform/freeform_run.h"
#include "tests/support/thresholds.h"
#include "twin/diagnose/diagnose.h"

// Runs of an implementation that shares nothing with the twin, each with one hidden effect or none.
namespace twinbench::freeform_test {
namespace {

std::string CasePath(const std::string& number, const std::string& file) {
  return TWINBENCH_TEST_DATA "/challenge_freeform/" + number + "/" + file;
}

diagnose::Diagnosis DiagnosisOfCase(const std::string& number) {
  diagnose::DiagnoseOptions options;
  options.null_runs = 200;  // enough for a threshold
  options.cache_folder = test::ThresholdsFolder();
  const std::vector<Reading> readings = ReadReadingsCsv(CasePath(number, "readings.csv"), kFreeformBench);
  return benches::freeform::Diagnose(readings, FreeformScenario(), options).diagnosis;
}

class FreeformChallenge : public testing::TestWithParam<std::string> {};

TEST_P(FreeformChallenge, IsAnsweredRightly) {
  const nlohmann::json truth = nlohmann::json::parse(std::ifstream(CasePath(GetParam(), "truth.json")));
  const std::string effect = truth.at("effect");
  const diagnose::Diagnosis diagnosis = DiagnosisOfCase(GetParam());
  if (effect == "none") {
    EXPECT_EQ(diagnosis.verdict, diagnose::Verdict::kNone);
    return;
  }
  if (effect == "unknown") {
    EXPECT_EQ(diagnosis.verdict, diagnose::Verdict::kUnknown);
    return;
  }
  std::vector<std::string> names;
  for (const diagnose::Cause& cause : diagnosis.causes) names.push_back(cause.effect);
  EXPECT_THAT(names, testing::Contains(effect));
  EXPECT_THAT(names, testing::IsSubsetOf(truth.at("alike").get<std::vector<std::string>>()));
  const bool is_answer =
      diagnosis.verdict == diagnose::Verdict::kNamed || diagnosis.verdict == diagnose::Verdict::kTie;
  EXPECT_TRUE(is_answer);
}

INSTANTIATE_TEST_SUITE_P(Freeform, FreeformChallenge, testing::Values("002", "007", "012", "016", "017"),
                         [](const testing::TestParamInfo<std::string>& test) { return "Case" + test.param; });

}  // namespace
}  // namespace twinbench::freeform_test
