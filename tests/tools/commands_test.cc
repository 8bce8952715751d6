#include <regex>

#include "tests/support/night.h"
#include "tests/tools/program_here.h"
#include "twin/core/bench_format.h"
#include "twin/core/scenario.h"

/// Commands that explain, list and check.
namespace twinbench::test {
namespace {

using testing::HasSubstr;

using Commands = SmallProgram;

TEST_F(Commands, ANewScenarioSaysWhatTheDefaultsSay) {
  for (const std::string& bench : BenchNames()) {
    Succeed({"new", bench, "-o", bench + ".toml"});
    EXPECT_EQ(WriteScenario(LoadScenario(At(bench + ".toml"))),
              WriteScenario(ParseScenario("bench = \"" + bench + "\"\n", "defaults", "", {})));
  }
  ExpectRefused({"new", "rotary_4dog"});
}

TEST_F(Commands, EveryKeyOfANewScenarioIsReadWhenItsHashIsTakenAway) {
  for (const std::string& bench : BenchNames()) {
    std::istringstream lines(Succeed({"new", bench}));
    std::string text;
    int keys = 0;
    for (std::string line; std::getline(lines, line);) {
      const bool is_effect = line.starts_with("#[[effect]]");
      if (is_effect) break;
      const bool is_key = std::regex_search(line, std::regex("^#( |[a-zA-Z_0-9]+ = |\\])")) && !line.starts_with("# ");
      keys += is_key;
      text += (is_key || line.starts_with("#  {") ? line.substr(1) : line) + "\n";
    }
    EXPECT_GT(keys, 10) << bench;
    EXPECT_EQ(WriteScenario(ParseScenario(text, bench, "", {})),
              WriteScenario(ParseScenario("bench = \"" + bench + "\"\n", "defaults", "", {})));
  }
}

TEST_F(Commands, ACheckSaysDurationLossesAndWhichUTheRunStates) {
  EXPECT_THAT(Succeed({"check", "small.toml", "--json", "check.json"}), HasSubstr("U = 2 u"));
  const nlohmann::json expected = JsonIn("check.json").at("expected");
  EXPECT_EQ(expected.at("readings"), 124);
  EXPECT_GT(expected.at("minutes"), 1.0);
  Succeed({"run", "small.toml", "-o", "run"});
  const nlohmann::json results = nlohmann::json::parse(Read("run/results.json"));
  EXPECT_EQ(expected.at("not_separable").size(), results.at("separation").at("not_separable").size());
  const auto u = std::ranges::find(expected.at("results"), "separation.target.ez_arcsec", [](const nlohmann::json& r) { return r.at("name"); });
  ASSERT_NE(u, expected.at("results").end());
  const double stated = results.at("separation").at("target").at("u_ez_arcsec")[0];
  EXPECT_NEAR(u->at("rms_u").get<double>() / stated, 1.0, 0.2);
}

TEST_F(Commands, ACheckForetellsThatARunComesToNothingOrLosesReadings) {
  const std::string dark = Succeed({"check", "small.toml", "--set", "psd_a.distance_mm=0.001", "--json", "dark.json"});
  EXPECT_THAT(dark, testing::AllOf(HasSubstr("its run is not. Bench"), HasSubstr("readings (full_circle): no_light\n"), HasSubstr("It would come to no result: ")));
  EXPECT_TRUE(JsonIn("dark.json").contains("no_results"));
  EXPECT_EQ(JsonIn("dark.json").at("lost_readings").at(0).at("phase"), "calibration");
  const std::string wide = Succeed({"check", "small.toml", "--set", "procedure.sweep_arcsec=5000"});
  EXPECT_THAT(wide, testing::AllOf(HasSubstr(" readings (calibration): no_light\n"), HasSubstr("U = 2 u")));
  EXPECT_THAT(Succeed({"check", "small.toml"}), testing::Not(HasSubstr("It would")));
  // All numbers of results that were taken back are null, orders too.
  EXPECT_THAT(Succeed({"check", "small.toml", "--set", "target.random.ez_arcsec=3600"}), HasSubstr("It would lose "));
  Write("collimator.toml",
        "bench = \"turntable_autocollimator\"\n[multitooth]\nteeth = 3\n[turntable_procedure]\nphases = [\"full_circle\"]\npositions = 3\n"
        "passes = [1]\ntilts_arcsec = [50.0]\neccentricities_um = [0.0]\n");
  EXPECT_THAT(Succeed({"check", "collimator.toml"}), HasSubstr("It would come to no result: its run: there are only 3 readings"));
  Write("part.toml", "bench = \"encoder_comparison\"\n[encoder_procedure]\nturns = 0.4\n");
  EXPECT_THAT(Succeed({"check", "part.toml", "--json", "part.json"}), HasSubstr("its run is not. Bench encoder_comparison, "));
  EXPECT_TRUE(JsonIn("part.json").contains("not_separated"));
}

TEST_F(Commands, WithoutAnyNoiseEveryBenchIsCheckedRunAndScored) {
  const std::string room = "environment.sensor_noise_mK=0";
  const std::map<std::string, std::vector<std::string>> none = {
      {"rotary_4dof",
       {room, "amplifier.noise_mV=0", "procedure.positions=12", "procedure.shifts=[0, 1, 5]", "mechanics.fidelity=kinematic"}},
      {"turntable_autocollimator", {room, "autocollimator.noise_arcsec=0"}},
      {"circular_motion", {room, "machine.noise_um=0", "bar.noise_um=0", "bar.resolution_um=0", "grid.noise_um=0", "encoder.noise_arcsec=0",
                           "circular_procedure.points=36", "circular_procedure.stops=6", "circular_procedure.feeds_mm_min=[1000]"}},
      {"encoder_comparison", {room, "device.noise_deg=0"}},
      {"hob_transmission", {"interferometer.noise_arcsec=0", "hob_procedure.turns=2", "hob_procedure.samples_per_turn=250"}},
      {"freeform_five_axis", {room, "qpd.noise_mV=0", "ccd.noise_px=0", "freeform_procedure.poses=25"}}};
  for (const auto& [bench, sets] : none) {
    Write(bench + ".toml", "bench = \"" + bench + "\"\n");
    std::vector<std::string> without;
    for (const std::string& set : sets) without.insert(without.end(), {"--set", set});
    EXPECT_THAT(Succeed(With({"check", bench + ".toml"}, without)), HasSubstr(": fine. Bench " + bench));
    Succeed(With({"run", bench + ".toml", "-o", bench}, without));
    Succeed({"score", bench});
  }
}

TEST_F(Commands, ARunWhoseEffectIsTooLargeForTheModelSaysSo) {
  Write("large.toml", std::string(kSmall) + "[psd_b]\ndistance_mm = 210.0\n[[effect]]\nname = \"psd_nonlinearity\"\nwhere = \"psd_b\"\ncubic_per_m2 = 600000.0\n");
  const Outcome run = Call({"run", "large.toml", "-o", "large"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, testing::AllOf(HasSubstr("does not describe the readings"), HasSubstr("`twinbench diagnose` names")));
  EXPECT_THAT(Call({"score", "large"}).err, HasSubstr("`twinbench diagnose` names"));
}

TEST_F(Commands, ACirclesErrorsAreStatedToTheSecondDigitOfTheirU) {
  Write("circle.toml", "bench = \"circular_motion\"\n[circular_procedure]\npoints = 36\nstops = 6\nfeeds_mm_min = [1000.0]\n");
  const std::string said = Succeed({"run", "circle.toml", "-o", "circle"});
  EXPECT_TRUE(std::regex_search(said, std::regex("machine\\.lag_x_s +(−)?0\\.\\d+ ± 0\\.0+\\d\\d s\n"))) << said;
  EXPECT_THAT(Succeed({"score", "circle"}), HasSubstr("error of                           estimate-truth   stated u\n"));
}

TEST_F(Commands, APlanWithoutTimeSaysWhatItLeavesOutAndStillProposesARun) {
  const std::string said = Succeed({"plan", "small.toml", "--cpu", "0.001", "-o", "next.toml", "--json", "plan.json"});
  EXPECT_THAT(said, HasSubstr("With --cpu 0 all is."));
  EXPECT_TRUE(JsonIn("plan.json").at("left_out").contains("another run"));
  Succeed({"check", "next.toml"});
}

TEST_F(Commands, APlanThatCannotBeWrittenIsRefusedBeforeItIsMade) {
  for (const char* option : {"-o", "--json"}) {
    const Outcome plan = Call({"plan", "small.toml", "--cpu", "0.001", option, "no/such/next.toml"});
    EXPECT_EQ(plan.exit_code, 1);
    EXPECT_THAT(plan.err, HasSubstr("there is no folder no/such"));
    EXPECT_THAT(plan.err, testing::Not(HasSubstr("the run as the scenario says"))) << "nothing was computed";
  }
}

TEST_F(Commands, TheListHasEveryBenchAndEffect) {
  const nlohmann::json benches = Json({"list", "--json"}).at("benches");
  ASSERT_EQ(benches.size(), BenchFormats().size());
  const std::string text = Succeed({"list"});
  for (const auto& bench : benches) {
    EXPECT_THAT(text, HasSubstr(bench.at("name").get<std::string>()));
    for (const auto& effect : bench.at("effects"))
      EXPECT_THAT(text, HasSubstr(effect.at("name").get<std::string>()));
  }
}

TEST_F(Commands, AnEffectIsExplainedWithWhatItDoesForProgramsToo) {
  const std::string roll = Succeed({"explain", "psd_roll"});
  EXPECT_THAT(roll, HasSubstr("roll_mrad = 5 "));
  EXPECT_THAT(roll, HasSubstr("what it adds to psd_a_"));
  ExpectRefused({"explain", "psd_rol"});
  EXPECT_THAT(Succeed({"explain", "eccentricity", "--bench", "encoder_comparison", "--json", "told.json"}), HasSubstr("deg"));
  const nlohmann::json benches = JsonIn("told.json").at("benches");
  ASSERT_EQ(benches.size(), 1u);
  const nlohmann::json& told = benches.at(0);
  EXPECT_EQ(told.at("effect"), "eccentricity");
  EXPECT_FALSE(told.at("parameters").empty());
  const nlohmann::json& signature = told.at("signature");
  EXPECT_GT(signature.at("rms"), 0.0);
  EXPECT_EQ(signature.at("x").size(), signature.at("forward").size());
  EXPECT_NO_THROW(ParseScenario("bench = \"encoder_comparison\"\n", "usual", "", {told.at("set").get<std::string>()}));
}

TEST_F(Commands, ACampaignIsSummedUpForProgramsTooAndShowsResultsThatThereAreAndOnAPageOnly) {
  Write("small.toml", "bench = \"encoder_comparison\"\n[encoder_procedure]\nturns = 1\nstops_per_turn = 12\npasses = [1, -1]\n");
  Write("study.toml", "scenario = \"small.toml\"\ntrials = 3\n");
  ExpectRefused({"campaign", "study.toml", "-o", "t.sqlite", "--show", "reversal.mean_arcsec"}, "--web PORT");
  const nlohmann::json summary = Json({"campaign", "study.toml", "-o", "t.sqlite", "--json", "-"});
  EXPECT_EQ(summary.at("trials"), 3);
  EXPECT_TRUE(summary.at("lost").empty());
  EXPECT_EQ(summary.at("results").at("means.both.ez_arcsec[]").at("count"), 3 * 12);
  const Outcome unknown =
      Call({"campaign", "study.toml", "-o", "u.sqlite", "--web", "0", "--show", "reversal.mean_arcsek"});
  if (unknown.err.find("built without pages") != std::string::npos) GTEST_SKIP() << "no pages in this build";
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("the nearest is reversal.mean_arcsec"));
}

TEST_F(Commands, TheSchemaKnowsTheKeysOfEveryBench) {
  const nlohmann::json schema = Json({"schema"});
  ASSERT_EQ(schema.at("oneOf").size(), BenchFormats().size());
  const auto& rotary = schema.at("oneOf").at(0).at("properties");
  EXPECT_EQ(rotary.at("laser").at("properties").at("wavelength_nm").at("minimum"), 200.0);
  EXPECT_EQ(rotary.at("target").at("properties").at("random").at("type"), "object");
}

TEST_F(Commands, HelpExplainsKeysEffectsExitCodesAndWhatABenchFileHas) {
  const std::pair<std::vector<std::string>, std::vector<const char*>> cases[] = {
      {{"help", "scenario"}, {"[[fixture]]"}},
      {{"help", "scenario", "hob_transmission"}, {"# ---- bench hob_transmission ----", "[hob_procedure]"}},
      {{"help", "scenario", "laser"}, {"# ---- bench rotary_4dof ----\n[laser]\nwavelength_nm = 650\n"}},
      {{"help", "effects"}, {"psd_gain"}},
      {{"--help"}, {"Exit codes"}},
      {{"help", "bench"}, {"[adc]", "[goniometer]", "in_position_arcsec", "timeout_s", "attempts = 3"}},
      {{"help", "dialogue"}, {"elcomat ", "answer_ends = \"LF\"", "[tilt]"}}};
  for (const auto& [command, words] : cases) {
    const std::string text = Succeed(command);
    for (const char* word : words) EXPECT_THAT(text, HasSubstr(word));
  }
  EXPECT_THAT(Succeed({"help", "scenario", "laser"}), testing::Not(HasSubstr("[grating]")));
}

TEST_F(Commands, HelpOfACommandOpensWithWhatItAnswersAndTwoExamples) {
  std::istringstream script(Succeed({"completion"}));
  for (std::string line; std::getline(script, line);) {
    const std::size_t end = line.find(") words=");
    if (end == line.npos) continue;
    const std::string command = line.substr(4, end - 4), one = "  twinbench " + command + "[^\n]*\n";
    EXPECT_TRUE(std::regex_search(Succeed({command, "--help"}), std::regex("It answers:\n[A-Z][^\n]*\\?\n\nExamples:\n" + one + one))) << command;
  }
}

TEST_F(Commands, EveryShellCompletesCommandsAndOptions) {
  Write("complete.sh", Succeed({"completion"}) +
                           "COMP_WORDS=(twinbench di); COMP_CWORD=1; _twinbench; echo \"${COMPREPLY[*]}\"\n"
                           "COMP_WORDS=(twinbench measure --all); COMP_CWORD=2; _twinbench; echo \"${COMPREPLY[*]}\"\n");
  ASSERT_EQ(std::system(("bash " + At("complete.sh") + " > " + At("said")).c_str()), 0);
  EXPECT_EQ(Read("said"), "diagnose\n--allow-homing\n");
  EXPECT_THAT(Succeed({"completion", "zsh"}),
              testing::AllOf(testing::StartsWith("#compdef twinbench\n"), HasSubstr("    measure) found=(--help")));
  EXPECT_THAT(Succeed({"completion", "fish"}),
              HasSubstr("complete -c twinbench -n '__fish_seen_subcommand_from measure' -l allow-homing\n"));
}

/// Some looked at things for a minute and failed then.
TEST_F(Commands, APlanOfEveryShippedScenarioEndsByNight) {
  if (!IsNight()) GTEST_SKIP() << "some minutes";
  for (const auto& entry : std::filesystem::directory_iterator(TWINBENCH_SOURCE_DIR "/scenarios")) {
    if (entry.path().extension() != ".toml") continue;
    const Outcome plan = Call({"plan", entry.path().string()});
    EXPECT_EQ(plan.exit_code, 0) << entry.path() << "\n" << plan.err;
    EXPECT_THAT(plan.out, HasSubstr("minutes")) << entry.path();
  }
}

}  // namespace
}  // namespace twinbench::test
