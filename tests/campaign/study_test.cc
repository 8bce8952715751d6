#include "twin/campaign/study.h"

#include <gmock/gmock.h>

#include "tests/campaign/small_study.h"
#include "tests/core/input_error.h"

namespace twinbench::campaign {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

/// The first line of `lines` is line 12 of the study.
std::string Refusal(const std::string& lines) {
  return MessageOf([&] { ParseStudy(StudyOf(lines), "study.toml", ""); });
}

TEST(Study, RefusesAnUnknownKeyOfItsOwn) {
  EXPECT_THAT(Refusal("trails = 5\n"), AllOf(StartsWith("study.toml:12: "), HasSubstr("trials")));
}

TEST(Study, RefusesATypeThatIsWrong) {
  EXPECT_THAT(Refusal("trials = 2.5\n"),
              AllOf(StartsWith("study.toml:12: trials is 2.5"), HasSubstr("expected a whole number")));
}

TEST(Study, RefusesAVariedKeyThatTheBenchDoesNotHave) {
  EXPECT_THAT(Refusal("[[vary]]\nkey = \"device.noise_dag\"\nvalues = [0.1]\n"),
              AllOf(StartsWith("study.toml:13: "), HasSubstr("noise_deg")));
}

TEST(Study, RefusesAVariedKeyOfTheWrongType) {
  EXPECT_THAT(Refusal("[[vary]]\nkey = \"encoder_procedure.stops_per_turn\"\ndistribution = \"uniform\"\n"
                      "lower = 20\nupper = 41\n"),
              AllOf(StartsWith("study.toml:13: "), HasSubstr("expected a whole number")));
}

TEST(Study, RefusesAGridValueThatIsOutOfBounds) {
  EXPECT_THAT(Refusal("[[vary]]\nkey = \"device.noise_deg\"\nvalues = [0.1, -1]\n"),
              AllOf(StartsWith("study.toml:13: "), HasSubstr("-1"), HasSubstr("expected a number of deg")));
}

TEST(Study, RefusesADistributionWithoutAParameter) {
  EXPECT_THAT(Refusal("[[vary]]\nkey = \"device.noise_deg\"\ndistribution = \"normal\"\nmean = 1\n"),
              AllOf(StartsWith("study.toml:12: "), HasSubstr("has no sd")));
}

TEST(Study, RefusesAParameterOfAnotherDistribution) {
  EXPECT_THAT(Refusal("[[vary]]\nkey = \"device.noise_deg\"\ndistribution = \"normal\"\nmean = 1\nsd = 1\n"
                      "upper = 3\n"),
              AllOf(StartsWith("study.toml:17: "), HasSubstr("upper")));
}

TEST(Study, RefusesToVaryTheSeedOrAKeyTwice) {
  EXPECT_THAT(Refusal("[[vary]]\nkey = \"seed\"\nvalues = [1, 2]\n"), HasSubstr("cannot be varied"));
  const std::string once = "[[vary]]\nkey = \"device.noise_deg\"\nvalues = [0.1]\n";
  EXPECT_THAT(Refusal(once + once), HasSubstr("varied twice"));
}

TEST(Study, RefusesToHaveNoScenario) {
  EXPECT_THAT(MessageOf([] { ParseStudy("trials = 3\n", "study.toml", ""); }),
              AllOf(StartsWith("study.toml:1: "), HasSubstr("no scenario")));
}

TEST(Study, PutsItsFixedKeysIntoEveryTrial) {
  const Study study = ParseStudy(StudyOf("set = [\"title=mine\"]\n"), "study.toml", "");
  EXPECT_EQ(study.With({}).title, "mine");
  EXPECT_EQ(study.With({"title=another"}).title, "another");
  EXPECT_THAT(Refusal("set = [\"titel=mine\"]\n"), AllOf(StartsWith("study.toml:12: "), HasSubstr("title")));
}

}  // namespace
}  // namespace twinbench::campaign
