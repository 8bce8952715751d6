#include <gmock/gmock.h>

#include "tests/tools/program.h"

namespace twinbench::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class AngleComparison : public Program {
 protected:
  AngleComparison() {
    Write("angle.toml",
          "bench = \"encoder_comparison\"\n[encoder_procedure]\nturns = 1.0\nstops_per_turn = 36\n"
          "[[effect]]\nname = \"backlash\"\nwidth_deg = 1.0\n");
  }
};

TEST_F(AngleComparison, IsCarriedOutExportedAndImportedToTheSameResults) {
  const std::string summary = Succeed({"run", "angle.toml", "-o", "a"});
  EXPECT_THAT(summary, StartsWith("144 readings\n"));
  const auto truth = nlohmann::json::parse(Read("a/truth.json"));
  EXPECT_EQ(truth.at("effects").at(0).at("effect"), "backlash");
  EXPECT_NEAR(nlohmann::json::parse(Read("a/results.json")).at("mean_forward_deg"), -0.5, 0.001);
  Write("r.csv", ReadingsOf("a"));
  EXPECT_EQ(Succeed({"import", "r.csv", "--scenario", "angle.toml", "-o", "b"}), summary);
  EXPECT_EQ(Read("b/results.json"), Read("a/results.json"));
  EXPECT_EQ(Read("b/scenario.toml"), Read("a/scenario.toml"));
  EXPECT_EQ(ReadingsOf("b"), ReadingsOf("a"));
}

TEST_F(AngleComparison, HasNoTablesToSeparate) {
  Succeed({"run", "angle.toml", "-o", "a"});
  for (const char* command : {"separate", "score"}) {
    const Outcome outcome = Call({command, "a"});
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_EQ(outcome.err,
              "twinbench: bench encoder_comparison: there are no two tables whose errors could be separated; "
              "expected a run of rotary_4dof\n");
  }
}

TEST_F(AngleComparison, RefusesReadingsOfAnotherBench) {
  Write("small.toml", kSmall);
  MakeRun("rotary");
  Write("r.csv", ReadingsOf("rotary"));
  const Outcome outcome = Call({"import", "r.csv", "--scenario", "angle.toml", "-o", "b"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("required columns are missing: measured_deg; expected readings of the bench "
                                     "encoder_comparison"));
}

TEST_F(AngleComparison, RefusesErrorsOfTablesAndImages) {
  EXPECT_THAT(Call({"run", "angle.toml", "-o", "a", "--errors", "target=t.csv"}).err,
              HasSubstr("the bench encoder_comparison has no such table"));
  EXPECT_THAT(Call({"run", "angle.toml", "-o", "a", "--images"}).err,
              HasSubstr("the bench encoder_comparison has no light"));
  EXPECT_FALSE(Exists("a"));
}

}  // namespace
}  // namespace twinbench::test
