#include <gmock/gmock.h>

#include "tests/freeform/freeform_run.h"

namespace twinbench::freeform_test {
namespace {

constexpr const char* kShorter = "[freeform_procedure]\nposes = 45\n";  // for the time it takes

diagnose::Diagnosis DiagnosisWith(const std::string& hidden) {
  return DiagnosisOf(RunOf(FreeformScenario(kShorter + hidden)), FreeformScenario(kShorter));
}

TEST(FreeformDiagnosis, FindsNothingInARunThatHasNothing) {
  EXPECT_EQ(DiagnosisWith("").verdict, diagnose::Verdict::kNone);
}

struct Hidden {
  std::string name, more;
};

class FreeformDiagnosis : public testing::TestWithParam<Hidden> {};

TEST_P(FreeformDiagnosis, NamesTheCauseThatTheTwinHas) {
  const Hidden& hidden = GetParam();
  const diagnose::Diagnosis diagnosis = DiagnosisWith("[[effect]]\nname = \"" + hidden.name + "\"\n" + hidden.more + "\n");
  ASSERT_NE(diagnosis.verdict, diagnose::Verdict::kNone);
  EXPECT_THAT(NamesOf(diagnosis), testing::Contains(hidden.name));
}

// Sizes some ten times the noise of the run, all machine errors free.
INSTANTIATE_TEST_SUITE_P(
    Freeform, FreeformDiagnosis,
    testing::Values(Hidden{"qpd_gain", "where = \"qpd_y\"\nratio = 0.01"}, Hidden{"qpd_roll", "roll_rad = -0.04"},
                    Hidden{"vertex_radius", "ratio = 0.0004"},
                    Hidden{"cyclic", "where = \"x\"\ncosine_um = 0.3\nsine_um = 0.1\npitch_mm = 12.1"},
                    Hidden{"outliers", "fraction = 0.02\nsize_um = 12.0"}),
    [](const testing::TestParamInfo<Hidden>& test) { return test.param.name; });

/// Set-ups are a quarter of an hour apart: what the spindle did in between counts.
TEST(FreeformDiagnosis, SizesGrowthThatLagsBehindTheTemperature) {
  const std::string warm = "[environment]\nswing_mK = 700.0\nswing_period_s = 7000.0\n";
  const diagnose::Diagnosis diagnosis = DiagnosisWith("[[effect]]\nname = \"thermal_growth\"\nwhere = \"y\"\ngrowth_um_K = 4.0\nlag_s = 500.0\n" + warm);
  ASSERT_THAT(NamesOf(diagnosis), testing::ElementsAre("thermal_growth"));
  for (const auto& [name, truth] : {std::pair{"growth", 4e-6}, std::pair{"lag", 500.0}}) {
    const auto& all = diagnosis.causes.front().parameters;
    const auto found = std::ranges::find(all, name, &diagnose::ParameterEstimate::name);
    ASSERT_NE(found, all.end());
    EXPECT_NEAR(found->value, truth, 3.0 * found->u);
    EXPECT_LT(found->u, 0.3 * truth);
  }
}

std::string CasePath(const std::string& number, const std::string& file) {
  return TWINBENCH_TEST_DATA "/challenge_freeform/" + number + "/" + file;
}

/// Runs of an implementation that shares nothing with the twin, each with one hidden effect or none.
class FreeformChallenge : public testing::TestWithParam<std::string> {};

TEST_P(FreeformChallenge, IsAnsweredRightly) {
  using enum diagnose::Verdict;
  const nlohmann::json truth = nlohmann::json::parse(std::ifstream(CasePath(GetParam(), "truth.json")));
  const std::string effect = truth.at("effect");
  const diagnose::Diagnosis diagnosis =
      DiagnosisOf(ReadReadingsCsv(CasePath(GetParam(), "readings.csv"), kFreeformBench), FreeformScenario());
  if (effect == "none" || effect == "unknown") {
    EXPECT_EQ(diagnosis.verdict, effect == "none" ? kNone : kUnknown);
    return;
  }
  EXPECT_THAT(NamesOf(diagnosis), testing::Contains(effect));
  EXPECT_THAT(NamesOf(diagnosis), testing::IsSubsetOf(truth.at("alike").get<std::vector<std::string>>()));
  EXPECT_THAT(diagnosis.verdict, testing::AnyOf(kNamed, kTie));
}

INSTANTIATE_TEST_SUITE_P(Freeform, FreeformChallenge, testing::Values("002", "007", "012", "016", "017"),
                         [](const testing::TestParamInfo<std::string>& test) { return "Case" + test.param; });

}  // namespace
}  // namespace twinbench::freeform_test
