#include <gmock/gmock.h>

#include "tests/tools/program_here.h"

namespace twinbench::test {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;

/// Every mistake: code 2, nothing on stdout, one line, nothing new or changed in the folder.
class BadInput : public ProgramHere {
 protected:
  BadInput() { Write("small.toml", kSmall); }

  std::string Refusal(const std::vector<std::string>& arguments) {
    const auto before = Snapshot();
    const Outcome outcome = Call(arguments);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("; expected "));
    EXPECT_TRUE(before == Snapshot()) << "the folder has changed";
    return outcome.err;
  }
  std::string RefusalOf(const std::string& lines) {
    Write("bad.toml", "bench = \"rotary_4dof\"\n" + lines);
    return Refusal({"run", "bad.toml", "-o", "out"});
  }
  std::string RefusalOfOption(const std::string& option, const std::string& value) {
    return Refusal({"run", "small.toml", "-o", "out", option, value});
  }
};

TEST_F(BadInput, InAScenarioIsNamedWithItsLine) {
  EXPECT_EQ(RefusalOf("[laser]\nwavelenght_nm = 650\n"),
            "twinbench: bad.toml:3: unknown key laser.wavelenght_nm; expected a known one; the nearest is "
            "laser.wavelength_nm\n");
  EXPECT_EQ(RefusalOf("[laser]\nwavelength_nm = \"red\"\n"),
            "twinbench: bad.toml:3: laser.wavelength_nm is \"red\"; expected a number of nm from 200 to 2000\n");
  EXPECT_EQ(RefusalOf("[procedure]\npositions = 2\n"),
            "twinbench: bad.toml:3: procedure.positions is 2; expected a whole number from 3 to 100000\n");
  EXPECT_EQ(RefusalOf("[[effect]]\nname = \"psd_gian\"\n"),
            "twinbench: bad.toml:3: unknown effect \"psd_gian\"; expected a known one; the nearest is "
            "\"psd_gain\"\n");
  EXPECT_THAT(RefusalOf("[laser\n"), HasSubstr("bad.toml:2: "));
}

TEST_F(BadInput, OfAFileThatAScenarioNamesIsRefused) {
  EXPECT_THAT(RefusalOf("[target]\nerrors_file = \"none.csv\"\n"),
              MatchesRegex("twinbench: bad.toml:3: target.errors_file: the file .*none.csv cannot be read; .*\n"));
  Write("t.csv", "position_deg,ez_arcsec\n0,1\n90,x\n");
  EXPECT_THAT(RefusalOf("[target]\nerrors_file = \"t.csv\"\n"), HasSubstr("t.csv:3: "));
  EXPECT_THAT(RefusalOf("[environment]\ntemperature_file = \"t.csv\"\n"), HasSubstr("t.csv:1: "));
  Write("m.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 1 2\n");
  EXPECT_THAT(RefusalOf("[[fixture]]\nname = \"m\"\nmesh_file = \"m.stl\"\n"),
              MatchesRegex("twinbench: bad.toml:2: fixture.mesh_file: .*m.stl:4: a vertex has 2 coordinates.*\n"));
  EXPECT_THAT(RefusalOf("[laser]\nbeam = \"profile\"\nprofile_file = \"m.stl\"\n"), HasSubstr("m.stl"));
}

TEST_F(BadInput, OfABenchWithoutLightIsRefused) {
  EXPECT_THAT(RefusalOf("[laser]\nwavelength_nm = 1999\n"), HasSubstr("laser.wavelength_nm"));
}

TEST_F(BadInput, OfAFileThatIsNotThereIsRefused) {
  EXPECT_THAT(Refusal({"run", "none.toml", "-o", "out"}), HasSubstr("none.toml: the file cannot be read"));
  EXPECT_THAT(Refusal({"export", "none", "--readings", "r.csv"}), HasSubstr("none: there is no record.sqlite"));
  EXPECT_THAT(Refusal({"separate", "none"}), HasSubstr("none: does not exist"));
  EXPECT_THAT(Refusal({"score", "none"}), HasSubstr("none/truth.json"));
  EXPECT_THAT(Refusal({"import", "none.csv", "--scenario", "small.toml", "-o", "out"}), HasSubstr("none.csv"));
}

TEST_F(BadInput, InAnOptionIsNamed) {
  EXPECT_EQ(RefusalOfOption("--set", "procedure.positons=12"),
            "twinbench: --set procedure.positons=12: unknown key procedure.positons; expected a known one; the "
            "nearest is procedure.positions\n");
  EXPECT_THAT(RefusalOfOption("--set", "positions"), HasSubstr("--set positions: there is no \"=\""));
  for (const char* seed : {"-1", "1.5", "many", "18446744073709551616", ""}) RefusalOfOption("--seed", seed);
  EXPECT_THAT(RefusalOfOption("--fidelity", "best"), HasSubstr("best"));
  EXPECT_THAT(RefusalOfOption("--frob", "1"), HasSubstr("--frob"));
  EXPECT_THAT(RefusalOfOption("--errors", "table=t.csv"), HasSubstr("names no table; expected target=FILE.csv"));
  EXPECT_THAT(RefusalOfOption("--errors", "target"), HasSubstr("names no table; expected target=FILE.csv"));
  EXPECT_THAT(RefusalOfOption("--errors", "target=none.csv"), HasSubstr("none.csv: the file cannot be opened"));
  Write("t.csv", "position_deg,ez_urad\n0,1\n");
  EXPECT_THAT(RefusalOfOption("--errors", "target=t.csv"), HasSubstr("t.csv:1: unknown column ez_urad"));
  EXPECT_THAT(Refusal({"run", "small.toml"}), HasSubstr("--output"));
}

TEST_F(BadInput, OfACommandNamesTheCommands) {
  EXPECT_THAT(Refusal({"run", "s.toml", "-o", "x", "--noisefree"}),
              HasSubstr("run: there is no option --noisefree; the nearest is --noise-free"));
  EXPECT_THAT(Refusal({"run", "s.toml", "-o", "x", "--set", "a=1", "b=2"}), HasSubstr("there is no place for \"b=2\""));
  EXPECT_THAT(Refusal({"seperate"}), HasSubstr("unknown command seperate; expected one of run, "));
  EXPECT_THAT(Refusal({}), HasSubstr("there is no command; expected one of run, "));
}

/// Mistakes in what follows a run.
class BadReadings : public BadInput {
 protected:
  BadReadings() {
    BeginWith("bad readings", [this] { MakeRun("run"); });
    readings_ = ReadingsOf("run");
  }
  std::string RefusalOfReadings(const std::string& text) {
    Write("bad.csv", text);
    const std::string refusal = Refusal({"import", "bad.csv", "--scenario", "small.toml", "-o", "out"});
    EXPECT_EQ(Refusal({"separate", "bad.csv", "--scenario", "small.toml", "--json", "out.json"}), refusal);
    return refusal;
  }
  std::string readings_;
};

TEST_F(BadReadings, OfAFolderThatHoldsARunLeaveThatRunIntact) {
  EXPECT_THAT(Refusal({"run", "small.toml", "-o", "run", "--seed", "9"}), HasSubstr("there is a record already"));
  Write("readings.csv", readings_);
  EXPECT_THAT(Refusal({"import", "readings.csv", "--scenario", "small.toml", "-o", "run"}),
              HasSubstr("there is a record already"));
}

TEST_F(BadReadings, WithoutARequiredColumnNameIt) {
  std::string text = readings_;
  text.replace(text.find("psd_b_x_V"), 9, "psd_c_x_V");
  EXPECT_THAT(RefusalOfReadings(text), HasSubstr("bad.csv:1: required columns are missing: psd_b_x_V; expected"));
}

TEST_F(BadReadings, ThatAreCutOffNameTheLine) {
  const std::size_t line_80 = [&] {
    std::size_t at = 0;
    for (int line = 1; line < 80; ++line) at = readings_.find('\n', at) + 1;
    return at;
  }();
  EXPECT_THAT(RefusalOfReadings(readings_.substr(0, line_80 + 40)), HasSubstr("bad.csv:80: "));
  EXPECT_THAT(RefusalOfReadings(""), HasSubstr("bad.csv"));
}

TEST_F(BadReadings, WithAFieldThatIsNoNumberNameTheLine) {
  std::string text = readings_;
  text.insert(text.find('\n') + 1, "x");
  EXPECT_THAT(RefusalOfReadings(text), HasSubstr("bad.csv:2: "));
}

TEST_F(BadReadings, WithoutAFullCircleCannotBeSeparated) {
  const auto is_circle = [](const std::string& line) { return line.find("full_circle") != std::string::npos; };
  std::istringstream lines(readings_);
  std::string text;
  for (std::string line; std::getline(lines, line);) text += is_circle(line) ? "" : line + "\n";
  Write("calibration.csv", text);
  EXPECT_THAT(Refusal({"separate", "calibration.csv", "--scenario", "small.toml"}),
              HasSubstr("there are no usable full-circle readings"));
}

TEST_F(BadReadings, WithoutAScenarioAskForOne) {
  Write("readings.csv", readings_);
  EXPECT_THAT(Refusal({"separate", "readings.csv"}), HasSubstr("expected --scenario SCENARIO.toml"));
}

TEST_F(BadReadings, OfAnUnknownEstimatorAreRefused) {
  EXPECT_THAT(Refusal({"separate", "run", "--estimator", "best"}), HasSubstr("best"));
}

TEST_F(BadReadings, OfARecordThatIsNoneAreRefused) {
  std::filesystem::create_directory(At("odd"));
  Write("odd/record.sqlite", "not a database, but long enough to look at its first page");
  EXPECT_THAT(Refusal({"export", "odd", "--readings", "r.csv"}), HasSubstr("odd/record.sqlite"));
}

}  // namespace
}  // namespace twinbench::test
