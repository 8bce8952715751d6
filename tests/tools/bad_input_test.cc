#include "tests/tools/program_here.h"

/// Every mistake is refused as ProgramHere::Refusal says, and named.
namespace twinbench::test {
namespace {

using testing::HasSubstr;

using BadInput = SmallProgram;

TEST_F(BadInput, InAScenarioOrAFileThatItNamesIsToldWithItsLine) {
  Write("t.csv", "position_deg,ez_arcsec\n0,1\n90,x\n");
  Write("m.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 1 2\n");
  const std::pair<const char*, std::string> cases[] = {
      {" bad.toml:3: ", "[laser]\nwavelenght_nm = 650\n"},
      {"laser.wavelength_nm", "[laser]\nwavelength_nm = 1999\n"},  // no light is left there
      {"t.csv:3: ", "[target]\nerrors_file = \"t.csv\"\n"},
      {"t.csv:1: ", "[environment]\ntemperature_file = \"t.csv\"\n"},
      {"m.stl:4: ", "[[fixture]]\nname = \"m\"\nmesh_file = \"m.stl\"\n"},
      {"m.stl", "[laser]\nbeam = \"profile\"\nprofile_file = \"m.stl\"\n"}};
  for (const auto& [place, lines] : cases) {
    SCOPED_TRACE(lines);
    Write("bad.toml", "bench = \"rotary_4dof\"\n" + lines);
    ExpectRefused({"run", "bad.toml", "-o", "out"}, place);
  }
  Write("bad.toml", "bench = \"rotary_4dof\"\n[laser\n");
  EXPECT_THAT(Refusal({"run", "bad.toml", "-o", "out"}), HasSubstr(" bad.toml:2: "));
}

TEST_F(BadInput, WithoutEndIsRefused) {
  ExpectRefused({"run", "/dev/zero", "-o", "out"}, "larger than 256 MB");
  ExpectRefused({"separate", "/dev/zero", "--scenario", "small.toml"}, "larger than 256 MB");
  std::string header = "reading";
  for (int k = 0; k < 5000; ++k) header += ",x" + std::to_string(k);
  Write("wide.csv", header + "\n");
  ExpectRefused({"separate", "wide.csv", "--scenario", "small.toml"}, "wide.csv:1: 5001 columns");
  ExpectRefused({"import", "wide.csv", "--scenario", "small.toml", "-o", "out"}, "columns");
}

/// An effect of some twenty pixels, of which the fit knows nothing: nothing may be certain of its numbers.
TEST_F(BadInput, ThatNoFitDescribesHasNoResult) {
  Write("five.toml", "bench = \"freeform_five_axis\"\n[freeform_procedure]\nposes = 30\n"
                     "[[effect]]\nname = \"slope_crosstalk\"\nper_spot_px = 50.0\n");
  const Outcome run = Call({"run", "five.toml", "-o", "run"});
  ExpectEnded(run, 2, {"does not describe the readings: ccd leaves "});
  EXPECT_THAT(run.out, testing::AllOf(HasSubstr("no result: the fit "), testing::Not(HasSubstr("µm rms"))));
  const nlohmann::json results = nlohmann::json::parse(Read("run/results.json"));
  EXPECT_TRUE(results.contains("not_described"));
  EXPECT_TRUE(results.at("error_map").at("u_dx_um").at(0).is_null());
  for (const char* command : {"separate", "score"}) EXPECT_THAT(Refusal({command, "run"}), HasSubstr("ccd leaves "));
}

TEST_F(BadInput, ThatAnotherWiringDescribesHasNoResult) {
  Write("swapped.toml", Contents(TWINBENCH_SOURCE_DIR "/scenarios/rotary_4dof.toml") +
                            "[[effect]]\nname = \"convention\"\nwhere = \"swap_psds\"\n");
  ExpectEnded(Call({"run", "swapped.toml", "--set", "mechanics.fidelity=\"kinematic\"", "--set",
                    "procedure.positions=12", "-o", "run"}),
              2, {"times with PSD a and b exchanged"});
}

TEST_F(BadInput, WhatIsNoRunIsToldAsWhatItIsWithWhatToType) {
  ASSERT_EQ(Call({"run", "small.toml", "-o", "runs/first"}).exit_code, 0);
  Write("mine.csv", "reference_deg,encoder_deg\n0,0.1\n");
  std::filesystem::create_directory(At("empty"));
  for (const char* command : {"diagnose", "separate", "score", "report", "export", "uncertainty", "compensate"}) {
    SCOPED_TRACE(command);
    EXPECT_THAT(Refusal({command, "runs"}), HasSubstr("runs: a folder of 1 run, none itself; expected one of them: runs/first"));
    EXPECT_THAT(Refusal({command, "empty"}), HasSubstr("empty: a folder without a run"));
    EXPECT_THAT(Refusal({command, "mine.csv"}), HasSubstr("`twinbench import mine.csv -o runs/mine`"));
    EXPECT_THAT(Refusal({command, "small.toml"}), HasSubstr("`twinbench run small.toml -o runs/small`"));
    EXPECT_THAT(Refusal({command, "runs/frist"}), HasSubstr("the nearest is runs/first"));
  }
}

TEST_F(BadInput, WhatIsNoBenchFileOrScenarioOfTheRunIsToldAsWhatItIs) {
  Write("machine.toml", "kind = \"hardware\"\n[machine]\nkind = \"esp\"\n");
  Write("turntable.toml", "bench = \"turntable_autocollimator\"\n");
  Write("tables.toml", "kind = \"hardware\"\n[adc]\nkind = \"scpi\"\n");
  EXPECT_THAT(Refusal({"measure", "small.toml", "--bench", "turntable.toml", "-o", "m"}),
              HasSubstr("turntable.toml: a scenario of turntable_autocollimator, no bench file; expected the file that says where the devices of rotary_4dof are"));
  EXPECT_THAT(Refusal({"measure", "small.toml", "--bench", "machine.toml", "-o", "m"}), HasSubstr("[machine], so of a machine"));
  EXPECT_THAT(Refusal({"measure", "turntable.toml", "--bench", "tables.toml", "-o", "m"}), HasSubstr("[adc], so of two tables"));
  Write("encoder.toml", "bench = \"encoder_comparison\"\n");
  ASSERT_EQ(Call({"run", "small.toml", "-o", "run"}).exit_code, 0);
  for (const char* command : {"diagnose", "separate"})
    EXPECT_THAT(Refusal({command, "run", "--scenario", "encoder.toml"}),
                HasSubstr("encoder.toml: a scenario of bench encoder_comparison; expected one of rotary_4dof"));
}

TEST_F(BadInput, InAWordOrANumberIsToldWithWhatWouldBeRightAndTheNearest) {
  EXPECT_THAT(Refusal({"separate", "run", "--estimator", "rigorus"}), HasSubstr("there is no \"rigorus\" among published, rigorous; the nearest is rigorous"));
  EXPECT_THAT(Refusal({"help", "efects"}), HasSubstr("the nearest is effects"));
  EXPECT_THAT(Refusal({"help", "scenario", "rotary"}), HasSubstr("the nearest is rotary_4dof"));
  EXPECT_THAT(Refusal({"help", "scenario", "lasr"}), HasSubstr("the nearest is laser"));
  EXPECT_THAT(Refusal({"completion", "fihs"}), HasSubstr("the nearest is fish"));
  EXPECT_THAT(Refusal({"plan", "small.toml", "--goal", "taget.ez"}), HasSubstr("the nearest is target.ez"));
  EXPECT_THAT(Refusal({"plan", "small.toml", "--goal", "separaton.reference.ez"}), HasSubstr("the nearest is separation.reference.ez"));
  EXPECT_THAT(Refusal({"score", "run", "--aganst", "x"}), HasSubstr("the nearest is --against"));
  EXPECT_THAT(Refusal({"score", "run", "--table", "x"}), testing::Not(HasSubstr("nearest"))) << "no option is meant by it";
  EXPECT_THAT(Refusal({"completion", "tcsh"}), testing::Not(HasSubstr("nearest"))) << "nor any of these words";
  EXPECT_THAT(Refusal({"plan", "small.toml", "--minutes", "2h"}), HasSubstr("\"2h\" is not allowed; expected a number above 0"));
  ExpectRefused({"budget", "small.toml"}, "a place in results.json that has, as calibration");
}

/// What ended a run in words of its functions, or never, is said when the scenario is loaded.
TEST_F(BadInput, OfASizeThatNobodyBuildsIsRefused) {
  const std::pair<const char*, const char*> cases[] = {
      {"rotary_4dof", "adc.rate_kHz=1e-300"},        {"rotary_4dof", "target.speed_deg_s=1e-9"},
      {"rotary_4dof", "psd_b.window_gap_mm=0.0"},    {"rotary_4dof", "mechanics.step_us=1e-9"},
      {"hob_transmission", "hob_procedure.poll_s=1e-10"}, {"circular_motion", "circular_procedure.feeds_mm_min=[1e-300]"},
      {"freeform_five_axis", "ccd.image_mm=1e-300"}, {"turntable_autocollimator", "turntable.speed_deg_s=1e-300"}};
  for (const auto& [bench, set] : cases) {
    Write("bad.toml", std::string("bench = \"") + bench + "\"\n");
    ExpectRefused({"run", "bad.toml", "-o", "out", "--set", set});
  }
}

TEST_F(BadInput, OfANearlyRightFileNamesTheRightOneBesideItOrAmongTheShippedScenarios) {
  ExpectRefused({"run", "smal.toml", "-o", "out"}, "smal.toml: ");
  ExpectRefused({"check", "here/small.toml"}, "here/small.toml: ");
  std::filesystem::create_directories(At("scenarios/studies"));
  for (const char* shipped : {"encoder_heads", "studies/coverage_hob", "rotary_4dof"}) Write("scenarios/" + std::string(shipped) + ".toml", kSmall);
  for (const char* bare : {"encoder_heads", "encoder_haeds.toml", "coverage_hob", "rotary_4dof.toml"}) {
    const std::string said = Refusal({"check", bare});
    EXPECT_THAT(said, testing::ContainsRegex("the nearest is .*scenarios/(studies/)?[a-z0-9_]*\\.toml")) << bare;
  }
  EXPECT_THAT(Refusal({"check", "quite_another_thing.toml"}), testing::Not(HasSubstr("nearest")));
  EXPECT_THAT(Refusal({"check", "."}), HasSubstr(".: is a folder"));
}

TEST_F(BadInput, InAnOptionIsNamedAndOfACommandAllCommands) {
  Write("t.csv", "position_deg,ez_urad\n0,1\n");
  const std::pair<const char*, const char*> cases[] = {
      {"--set", "procedure.positons=12"}, {"--set", "positions"}, {"--seed", "-1"}, {"--seed", "1.5"},
      {"--seed", "many"}, {"--seed", "18446744073709551616"}, {"--seed", ""}, {"--frob", "1"},
      {"--errors", "table=t.csv"}, {"--errors", "target"}, {"--errors", "target=none.csv"},
      {"--errors", "target=t.csv"}};
  for (const auto& [option, value] : cases) ExpectRefused({"run", "small.toml", "-o", "out", option, value});
  ExpectRefused({"run", "small.toml"}, "--output");
  EXPECT_THAT(Refusal({"run", "small.toml", "-o", "out", "--fidelity", "best"}), HasSubstr("best"));
  ExpectRefused({"run", "s.toml", "-o", "x", "--noisefree"}, "--noise-free");
  ExpectRefused({"run", "s.toml", "-o", "x", "--set", "a=1", "b=2"}, "\"b=2\"");
  ExpectRefused({"seperate"}, "run, ");
  ExpectRefused({}, "run, ");
}

using BadReadings = SmallProgram;

TEST_F(BadReadings, WithoutAFullCircleOrAScenarioCannotBeSeparated) {
  MakeRun("run");
  Write("readings.csv", ReadingsOf("run"));
  std::istringstream lines(Read("readings.csv"));
  std::string calibration;
  for (std::string line; std::getline(lines, line);)
    calibration += line.find("full_circle") == std::string::npos ? line + "\n" : "";
  Write("calibration.csv", calibration);
  ExpectRefused({"separate", "calibration.csv", "--scenario", "small.toml"});
  ExpectRefused({"separate", "readings.csv"}, "--scenario SCENARIO.toml");
}

}  // namespace
}  // namespace twinbench::test
