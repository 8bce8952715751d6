#include <pty.h>

#include "tests/tools/program_here.h"
#include "twin/core/run_record.h"

namespace twinbench::test {
namespace {

using testing::HasSubstr, testing::Not, testing::StartsWith;

class Run : public SmallProgram {};

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

TEST_F(Run, TakesOverridesFidelityNoiseFreeAndImagesAndOptionsInFrontOfTheScenario) {
  MakeRun("a", {"--set", "procedure.positions=8", "--set", "procedure.shifts=[0,3]", "--fidelity", "bullet",
                "--noise-free", "--images", "--set", "laser.beam=gaussian"});
  EXPECT_TRUE(Exists("a/images/irradiance.exr"));
  const std::string scenario = Read("a/scenario.toml");
  for (const char* line :
       {"positions = 8\n", "shifts = [0, 3]\n", "fidelity = \"bullet\"\n", "noise_free = true\n"})
    EXPECT_THAT(scenario, HasSubstr(line));
  Succeed({"run", "--set", "procedure.passes=[1]", "--set", "seed=3", "small.toml", "-o", "run"});
  EXPECT_TRUE(Exists("run/results.json"));
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

TEST_F(Run, EntersItsMountingsInTheRecord) {
  MakeRun("run");
  const auto events = RunRecord::Open(At("run"))->Events();
  ASSERT_EQ(events.size(), 4u);  // calibration and three set-ups
  EXPECT_EQ(events[3].device, "fixture");
  EXPECT_EQ(events[3].text, "mounting 2: grating clamped at 0 deg, body seated at -150 deg");
}

class AngleComparison : public SmallProgram {
 protected:
  AngleComparison() {
    Write("angle.toml",
          "bench = \"encoder_comparison\"\n[encoder_procedure]\nturns = 1.0\nstops_per_turn = 36\n"
          "[[effect]]\nname = \"backlash\"\nwidth_deg = 1.0\n");
  }
};

TEST_F(AngleComparison, OfAPartOfATurnIsEvaluatedButNotSeparated) {
  Succeed({"run", "angle.toml", "-o", "a", "--set", "encoder_procedure.turns=0.5"});
  EXPECT_EQ(nlohmann::json::parse(Read("a/results.json")).at("not_separated"),
            "no mounting has a complete turn in one direction");
  for (const char* command : {"separate", "score"})
    ExpectRefused({command, "a"}, "no mounting has a complete turn in one direction");
}

TEST_F(AngleComparison, ReportsTheReversalOfABacklashItsIsoValuesAndWithOneMountingThatItIsTheDifferenceThatItKnows) {
  Succeed({"run", "angle.toml", "-o", "a"});
  const auto results = nlohmann::json::parse(Read("a/results.json"));
  // The gap is 1 deg; noise of 7.2 arcsec in 72 readings each way leaves 1.2 arcsec.
  EXPECT_NEAR(results.at("reversal").at("mean_arcsec"), -3600.0, 5.0);
  EXPECT_EQ(results.at("reversal").at("reversal_arcsec").size(), 360u);
  const auto& iso = results.at("iso230_2").at(0);
  EXPECT_EQ(iso.at("axis").size(), 12u);
  EXPECT_EQ(iso.at("targets").size(), 36u);
  EXPECT_NEAR(iso.at("axis").at("mean B").at("value_arcsec"), -3600.0, 5.0);
  EXPECT_THAT(iso.at("missing").dump(), HasSubstr("2 forward runs"));

  const auto separation = nlohmann::json::parse(Succeed({"separate", "a", "--json", "-"}));
  EXPECT_FALSE(separation.contains("reference"));
  ASSERT_EQ(separation.at("not_separable").size(), 1u);
  EXPECT_EQ(separation.at("not_separable")[0].at("what"), "device and reference");
  EXPECT_THAT(Succeed({"score", "a"}), HasSubstr("with one mounting"));
}

TEST_F(AngleComparison, RefusesReadingsOfAnotherBenchErrorsOfTablesAndImages) {
  MakeRun("rotary");
  Write("r.csv", ReadingsOf("rotary"));
  ExpectRefused({"import", "r.csv", "--scenario", "angle.toml", "-o", "b"}, "measured_deg");
  ExpectRefused({"run", "angle.toml", "-o", "a", "--errors", "target=t.csv"});
  ExpectRefused({"run", "angle.toml", "-o", "a", "--images"});
}

// ... and on the turntable with autocollimator and on the hobbing machine.

class AngleBenches : public AngleComparison {
 protected:
  AngleBenches() {
    Write("turntable.toml",
          "bench = \"turntable_autocollimator\"\n"
          "turntable.harmonics = [{ order = 1, amplitude_arcsec = 6.0 }]\n"
          "autocollimator = { noise_arcsec = 0.1, roll_mrad = 5.0 }\n"
          "[turntable_procedure]\npositions = 12\ntilt_azimuths_deg = [0.0, 70.0]\nverification_positions = 24\n");
    Write("hob.toml",
          "bench = \"hob_transmission\"\n"
          "transmission.harmonics = [{ order = 1, amplitude_arcsec = 9.0, phase_deg = 30.0 }]\n"
          "table_encoder = { eccentricity_um = 2.0, noise_arcsec = 0.1 }\n"
          "[hob_procedure]\nheads_deg = [0.0, 170.0]\nturns = 2\nsamples_per_turn = 250\npoll_s = 5.0\n");
  }
};

TEST_F(AngleBenches, AreCarriedOutExportedAndImportedToTheSameResults) {
  for (const std::string bench : {"small", "turntable", "hob", "angle"}) {
    const std::string a = bench + "_a", b = bench + "_b";
    Succeed({"run", bench + ".toml", "-o", a});
    Write("r.csv", ReadingsOf(a));
    Succeed({"import", "r.csv", "--scenario", bench + ".toml", "-o", b});
    EXPECT_EQ(Read(b + "/results.json"), Read(a + "/results.json")) << bench;
    EXPECT_EQ(ReadingsOf(b), ReadingsOf(a)) << bench;
  }
}

TEST_F(AngleBenches, TurntableTakesErrorsFromAFile) {
  Write("t.csv", "position_deg,ez_arcsec\n0,0\n90,10\n180,0\n270,-10\n");
  Succeed({"run", "turntable.toml", "-o", "a", "--noise-free", "--errors", "turntable=t.csv", "--set",
           "multitooth.tooth_rms_arcsec=0"});
  const auto ez = JsonIn("a/results.json").at("separation").at("turntable").at("ez_arcsec");
  EXPECT_NEAR(ez.at(3).get<double>() - ez.at(9).get<double>(), 20.0, 0.01);
  ExpectRefused({"run", "turntable.toml", "-o", "b", "--errors", "target=t.csv"},
                "turntable=FILE.csv or multitooth=FILE.csv");
}

/// The program on a terminal, and into a pipe: colour and lines that are rewritten are for the first alone.

constexpr const char* kEscape = "\033";

class OnTerminal : public Program {
 protected:
  /// All that it writes to a terminal of its own.
  /// @param set  "NO_COLOR=1", one more in its environment.
  std::string Seen(const std::vector<std::string>& arguments, const char* set) {
    int terminal = -1;
    const pid_t child = forkpty(&terminal, nullptr, nullptr, nullptr);
    if (child == 0) {
      setenv("TERM", "xterm", 1);
      unsetenv("NO_COLOR");
      putenv(const_cast<char*>(set));
      std::vector<char*> words = {const_cast<char*>(TWINBENCH_PROGRAM)};
      for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
      words.push_back(nullptr);
      if (chdir(At("").c_str()) == 0) execv(TWINBENCH_PROGRAM, words.data());
      _exit(127);
    }
    std::string text;
    char piece[4096];
    for (ssize_t n = 0; (n = read(terminal, piece, sizeof piece)) > 0;) text.append(piece, static_cast<std::size_t>(n));
    close(terminal);
    int status = 0;
    waitpid(child, &status, 0);
    return text;
  }
};

TEST_F(OnTerminal, AFailureIsRedUnlessColourIsUnwanted) {
  EXPECT_THAT(Seen({"check", "none.toml"}, "NO_COLOR="), HasSubstr("\033[31mtwinbench: none.toml")) << "empty is as if it were not there";
  EXPECT_THAT(Seen({"check", "none.toml"}, "NO_COLOR=1"), Not(HasSubstr(kEscape)));
  EXPECT_THAT(Seen({"check", "none.toml"}, "TERM=dumb"), Not(HasSubstr(kEscape)));
  EXPECT_THAT(Call({"check", "none.toml"}).err, Not(HasSubstr(kEscape)));
}

TEST_F(OnTerminal, ProgressIsOneLineWithTheTimeLeft) {
  Write("small.toml", kSmall);
  EXPECT_THAT(Seen({"run", "small.toml", "-o", "seen"}, "NO_COLOR=1"), testing::ContainsRegex("\r\033.K *124 of 124 readings, .*, bench time [0-9:]+, 0:00 left"));
  const Outcome piped = Call({"run", "small.toml", "-o", "piped"});
  EXPECT_THAT(piped.err, Not(HasSubstr(kEscape)));
  EXPECT_THAT(piped.err, HasSubstr("124 of 124 readings")) << "a line each tenth";
}

TEST_F(OnTerminal, WhatTakesLongSaysWhatItDoesAndLeavesNoTraceOfIt) {
  Write("small.toml", kSmall);
  const std::string seen = Seen({"plan", "small.toml", "--cpu", "2"}, "NO_COLOR=1");
  EXPECT_THAT(seen, testing::ContainsRegex("\r\033.K[a-z].*, 0:0[1-9]\r\033.K"));
  EXPECT_THAT(Call({"plan", "small.toml", "--cpu", "0.5"}).err, Not(HasSubstr(kEscape)));
}

}  // namespace
}  // namespace twinbench::test
