#include "twin/campaign/study.h"

#include <gmock/gmock.h>

#include "tests/campaign/small_study.h"
#include "tests/core/input_error.h"
#include "tests/support/kept_text.h"

namespace twinbench::campaign {
namespace {

using testing::StartsWith;

/// The first line of `lines` is line 12 of the study.
std::string Refusal(const std::string& lines) {
  return MessageOf([&] { ParseStudy(StudyOf(lines), "study.toml", ""); });
}

TEST(Study, RefusesWhatCannotBeAndSaysWhere) {
  const std::string vary = "[[vary]]\nkey = \"device.noise_deg\"\n", once = vary + "values = [0.1]\n";
  const std::pair<int, std::string> cases[] = {
      {12, "trails = 5\n"},
      {12, "trials = 2.5\n"},
      {13, "[[vary]]\nkey = \"device.noise_dag\"\nvalues = [0.1]\n"},
      {13, "[[vary]]\nkey = \"encoder_procedure.stops_per_turn\"\ndistribution = \"uniform\"\nlower = 20\nupper = 41\n"},
      {13, vary + "values = [0.1, -1]\n"},
      {12, vary + "distribution = \"normal\"\nmean = 1\n"},
      {17, vary + "distribution = \"normal\"\nmean = 1\nsd = 1\nupper = 3\n"},
      {13, "[[vary]]\nkey = \"seed\"\nvalues = [1, 2]\n"},
      {16, once + once},
      {12, "set = [\"titel=mine\"]\n"},
  };
  for (const auto& [line, lines] : cases) {
    EXPECT_THAT(Refusal(lines), StartsWith("study.toml:" + std::to_string(line) + ": "));
    EXPECT_KEPT(Refusal(lines));
  }
  EXPECT_KEPT(MessageOf([] { ParseStudy("trials = 3\n", "study.toml", ""); }));
}

TEST(Study, PutsItsFixedKeysIntoEveryTrial) {
  const Study study = ParseStudy(StudyOf("set = [\"title=mine\"]\n"), "study.toml", "");
  EXPECT_EQ(study.With({}).title, "mine");
  EXPECT_EQ(study.With({"title=another"}).title, "another");
}

}  // namespace
}  // namespace twinbench::campaign
