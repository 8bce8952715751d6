#include "tests/tools/program_here.h"
#include "twin/core/run_record.h"

namespace twinbench::test {
namespace {

using testing::HasSubstr, testing::Not, testing::StartsWith;

class Run : public ProgramHere {
 protected:
  Run() { Write("small.toml", kSmall); }
};

TEST_F(Run, LeavesScenarioRecordTruthAndResultsAndPrintsThemToStdoutAndProgressToStderr) {
  const Outcome outcome = Call({"run", "small.toml", "-o", "a/b"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* file : {"scenario.toml", "record.sqlite", "truth.json", "results.json"})
    EXPECT_TRUE(Exists(std::string("a/b/") + file)) << file;
  const auto results = nlohmann::json::parse(Read("a/b/results.json"));
  EXPECT_EQ(results.at("readings_by_status").at("ok"), 2 * 2 * 13 + 3 * 2 * 12);  // sweeps, then circles
  EXPECT_TRUE(results.at("separation").contains("target"));
  EXPECT_THAT(outcome.out, StartsWith("124 readings\n"));
  EXPECT_THAT(outcome.out, HasSubstr("table under test: target (laboratory frame)\n"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("bench time")));
  EXPECT_THAT(outcome.err, HasSubstr("124 of 124 readings, full_circle, bench time"));
  EXPECT_THAT(outcome.err, Not(HasSubstr("target table")));
}

TEST_F(Run, GivesTheSameBytesForTheSameSeedOnlyAndTakesEverySeedOf64Bits) {
  MakeRun("a");
  MakeRun("b");
  MakeRun("c", {"--seed", "6"});
  MakeRun("d", {"--set", "seed=6"});
  EXPECT_EQ(ReadingsOf("a"), ReadingsOf("b"));
  EXPECT_NE(ReadingsOf("a"), ReadingsOf("c"));
  EXPECT_EQ(ReadingsOf("c"), ReadingsOf("d"));
  MakeRun("last", {"--seed", "18446744073709551615"});
  EXPECT_THAT(Read("last/scenario.toml"), HasSubstr("seed = \"18446744073709551615\"\n"));
  Succeed({"run", "last/scenario.toml", "-o", "again"});
  EXPECT_EQ(ReadingsOf("last"), ReadingsOf("again"));
}

TEST_F(Run, TakesOverridesFidelityAndNoiseFree) {
  std::vector<std::string> options = {"--set", "procedure.positions=8", "--set", "procedure.shifts=[0,3]",
                                      "--fidelity", "bullet", "--noise-free"};
  MakeRun("a", options);
  const std::string scenario = Read("a/scenario.toml");
  for (const char* line :
       {"positions = 8\n", "shifts = [0, 3]\n", "fidelity = \"bullet\"\n", "noise_free = true\n"})
    EXPECT_THAT(scenario, HasSubstr(line));
  options.insert(options.end(), {"--seed", "5"});
  MakeRun("b", options);
  EXPECT_EQ(ReadingsOf("a"), ReadingsOf("b"));
}

TEST_F(Run, TakesTheErrorsOfATableFromAFile) {
  Write("t.csv", "position_deg,ez_arcsec\n0,7.25\n90,-1\n180,2\n270,-3\n");
  MakeRun("a", {"--errors", "target=t.csv", "--errors", "reference=t.csv"});
  const auto truth = nlohmann::json::parse(Read("a/truth.json"));
  for (const char* table : {"target", "reference"}) {
    // The file's angle 0 is the truth's first position; the scenario's own random errors are gone.
    EXPECT_NEAR(truth.at(table).at("ez_arcsec")[0], 7.25, 1e-9) << table;
    EXPECT_NEAR(truth.at(table).at("dy_um")[0], 0.0, 1e-12) << table;
  }
}

TEST_F(Run, WithoutUsableReadingsSaysSoAndSucceeds) {
  MakeRun("a", {"--set", "amplifier.offset_mV=[20000, 0, 0, 0]"});
  const auto results = nlohmann::json::parse(Read("a/results.json"));
  EXPECT_EQ(results.at("not_separated"), "there are no usable full-circle readings");
  EXPECT_EQ(results.at("readings_by_status").at("saturated"), 124);
}

TEST_F(Run, WritesImagesOnDemand) {
  MakeRun("a", {"--images", "--set", "laser.beam=gaussian"});
  EXPECT_TRUE(Exists("a/images/irradiance.exr"));
}

TEST_F(Run, EntersItsMountingsInTheRecord) {
  MakeRun("run");
  const auto events = RunRecord::Open(At("run"))->Events();
  ASSERT_EQ(events.size(), 4u);  // calibration and three set-ups
  EXPECT_EQ(events[3].device, "fixture");
  EXPECT_EQ(events[3].text, "mounting 2: grating clamped at 0 deg, body seated at -150 deg");
}

TEST_F(Run, TakesOptionsInFrontOfTheScenario) {
  Succeed({"run", "--set", "procedure.passes=[1]", "--set", "seed=3", "small.toml", "-o", "run"});
  EXPECT_TRUE(Exists("run/results.json"));
}

}  // namespace
}  // namespace twinbench::test
