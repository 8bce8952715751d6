#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/freeform/freeform_run.h"
#include "twin/diagnose/diagnose.h"

namespace twinbench::freeform_test {
namespace {

constexpr const char* kShorter = "[freeform_procedure]\nposes = 60\n";  // for the time it takes

diagnose::Diagnosis DiagnosisOf(const std::string& hidden) {
  const std::vector<Reading> readings = RunOf(FreeformScenario(kShorter + hidden));
  diagnose::DiagnoseOptions options;
  options.null_runs = 200;  // enough for a threshold
  return benches::freeform::Diagnose(readings, FreeformScenario(kShorter), options).diagnosis;
}

std::vector<std::string> NamesOf(const diagnose::Diagnosis& diagnosis) {
  std::vector<std::string> names;
  for (const diagnose::Cause& cause : diagnosis.causes) names.push_back(cause.effect);
  return names;
}

TEST(FreeformDiagnosis, FindsNothingInARunThatHasNothing) {
  EXPECT_EQ(DiagnosisOf("").verdict, diagnose::Verdict::kNone);
}

struct Hidden {
  std::string name, more;
};

class FreeformDiagnosis : public testing::TestWithParam<Hidden> {};

TEST_P(FreeformDiagnosis, NamesTheCauseThatTheTwinHas) {
  const Hidden& hidden = GetParam();
  const diagnose::Diagnosis diagnosis =
      DiagnosisOf("[[effect]]\nname = \"" + hidden.name + "\"\n" + hidden.more + "\n");
  ASSERT_NE(diagnosis.verdict, diagnose::Verdict::kNone);
  EXPECT_THAT(NamesOf(diagnosis), testing::Contains(hidden.name));
}

// Sizes some ten times the noise of the run, all machine errors free.
INSTANTIATE_TEST_SUITE_P(
    Freeform, FreeformDiagnosis,
    testing::Values(Hidden{"qpd_gain", "where = \"qpd_y\"\nratio = 0.01"}, Hidden{"qpd_roll", "roll_rad = -0.04"},
                    Hidden{"vertex_radius", "ratio = 0.0004"},
                    Hidden{"cyclic", "where = \"x\"\ncosine_um = 0.3\nsine_um = 0.1\npitch_mm = 12.1"}),
    [](const testing::TestParamInfo<Hidden>& test) { return test.param.name; });

}  // namespace
}  // namespace twinbench::freeform_test
