#include "tests/tools/program_here.h"
#include "twin/core/run_record.h"

/// What somebody tried who wanted to see it break, or mistyped.
namespace twinbench::test {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

class Attack : public SmallProgram {
 protected:
  int ExitOfShell(const std::string& command) const {
    return WEXITSTATUS(
        std::system(("cd " + At("") + " && " TWINBENCH_PROGRAM " " + command + " 2> /dev/null").c_str()));
  }
  static std::string Dotted(int parts) {
    std::string key;
    for (int k = 0; k < parts; ++k) key += "a.";
    return key + "a = 1";
  }
};

TEST_F(Attack, KeysAndWatchesWithoutEndAreRefusedInEveryFile) {
  Write("bad.toml", kSmall + Dotted(100000) + "\n");
  ExpectRefused({"run", "bad.toml", "-o", "out"}, "bad.toml:");
  Write("bench.toml", "kind = \"twin\"\n" + std::string(200000, 'k') + "= 1\n");
  ExpectRefused({"measure", "small.toml", "--bench", "bench.toml", "-o", "out"}, "bench.toml:2: ");
  EXPECT_THAT(Refusal({"run", "small.toml", "-o", "out", "--set", Dotted(1000)}), HasSubstr("a key of 1001 parts"));
  ExpectRefused({"run", "small.toml", "-o", "out", "--set", "procedure.stability_s=1e8", "--set",
                 "procedure.stability_interval_s=0.01"},
                " are 1e+10 readings");
}

TEST_F(Attack, AnOutputIsNoFileOfTheUserNoInputAndNoRecord) {
  Write("scenario.toml", kSmall);
  Write("bench.toml", "kind = \"twin\"\n");
  ExpectRefused({"run", "scenario.toml", "-o", "."}, "scenario.toml: ");
  ExpectRefused({"measure", "small.toml", "--bench", "bench.toml", "-o", "."}, "scenario.toml: ");
  MakeRun("run");
  Succeed({"export", "run", "--readings", "readings.csv"});
  ExpectRefused({"export", "run", "--readings", "run/record.sqlite"});
  ExpectRefused({"export", "run", "--readings", "run"});
  for (const char* output : {"small.toml", "readings.csv", "./small.toml"})
    ExpectRefused({"separate", "readings.csv", "--scenario", "small.toml", "--json", output});
  ExpectRefused({"diagnose", "readings.csv", "--scenario", "small.toml", "-o", "small.toml"});
}

TEST_F(Attack, WhatIsThereStaysUnlessForceIsSaid) {
  MakeRun("run");
  Write("notes.txt", "three weeks of work");
  const std::vector<std::string> commands[] = {{"export", "run", "--readings", "notes.txt"},
                                               {"new", "rotary_4dof", "-o", "notes.txt"},
                                               {"plan", "small.toml", "-o", "notes.txt"},
                                               {"certificate", "--template", "-o", "notes.txt"},
                                               {"serve", "small.toml", "--write-bench", "notes.txt"}};
  for (const std::vector<std::string>& command : commands) ExpectRefused(command, "notes.txt: ");
  Succeed({"export", "run", "--readings", "notes.txt", "--force"});
  EXPECT_EQ(Read("notes.txt"), ReadingsOf("run"));
  Write("place", "");  // made by somebody who wanted a name of his own
  Succeed({"new", "rotary_4dof", "-o", "place"});
}

TEST_F(Attack, OnlyARunOfTheTwinIsMadeAgain) {
  MakeRun("run");
  const std::string before = ReadingsOf("run");
  ExpectRefused({"run", "small.toml", "-o", "run", "--seed", "6"}, "--force");
  Succeed({"run", "small.toml", "-o", "run", "--seed", "6", "--force"});
  EXPECT_NE(ReadingsOf("run"), before);
  Succeed({"export", "run", "--readings", "readings.csv"});
  Succeed({"import", "readings.csv", "--scenario", "small.toml", "-o", "imported"});
  ExpectRefused({"run", "small.toml", "-o", "imported", "--force"});
  ExpectRefused({"import", "readings.csv", "--scenario", "small.toml", "-o", "run"});
  Write("scenario.toml", kSmall);
  ExpectRefused({"run", "scenario.toml", "-o", ".", "--force"});
}

TEST_F(Attack, WhatIsExchangedInARunIsSaidByEveryCommandThatReadsIt) {
  MakeRun("run");
  Succeed({"run", "small.toml", "-o", "other", "--seed", "6"});
  for (const std::string file : {"scenario.toml", "truth.json", "results.json", "record.sqlite"}) {
    const std::string mixed = "mixed_" + file;
    std::filesystem::copy(At("run"), At(mixed), std::filesystem::copy_options::recursive);
    std::filesystem::copy(At("other/" + file), At(mixed + "/" + file), std::filesystem::copy_options::overwrite_existing);
    for (const char* command : {"separate", "score", "diagnose", "export", "uncertainty"})
      EXPECT_THAT(Refusal({command, mixed}), HasSubstr("not as it was written")) << file;
  }
}

TEST_F(Attack, AnOutputIsBehindTheLinkThatNamesItAndWholeOrNotThere) {
  MakeRun("run");
  Write("readings.csv", "");
  std::filesystem::create_symlink("readings.csv", At("link.csv"));
  Succeed({"export", "run", "--readings", "link.csv"});
  EXPECT_TRUE(std::filesystem::is_symlink(At("link.csv")));
  EXPECT_EQ(Read("readings.csv"), ReadingsOf("run"));
  std::filesystem::create_directory(At("taken.csv.part"));
  EXPECT_EQ(Call({"export", "run", "--readings", "taken.csv"}).exit_code, 1);
  EXPECT_FALSE(Exists("taken.csv")) << "not written in place";
}

TEST_F(Attack, ADiskThatIsFullIsNoSuccess) {
  MakeRun("run");
  for (const char* command :
       {"export run > ", "export run --readings ", "separate run > ", "separate run --json ", "score run > "})
    EXPECT_EQ(ExitOfShell(command + std::string("/dev/full")), 1) << command;
  EXPECT_EQ(ExitOfShell("score run > /dev/null"), 0);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST_F(Attack, ResumeNamesTheRunThatIsNotThere) {
  Write("bench.toml", "kind = \"twin\"\n");
  const auto measure = [](const std::string& folder) {
    return std::vector<std::string>{"measure", "small.toml", "--bench", "bench.toml", "-o", folder, "--resume"};
  };
  const Outcome anew = Call(measure("tuesday"));
  EXPECT_EQ(anew.exit_code, 0);
  EXPECT_KEPT(anew.out.substr(0, anew.out.find('\n')));
  RunRecord::Create(At("monday"), {"test", "twin", 5, "", "rotary_4dof"});  // begun, and ended before its first reading
  ExpectRefused(measure("mondya"), "--resume: there is no run in mondya");
}

TEST_F(Attack, WhoFollowsARunThatWasKilledIsTold) {
  Process run(At(""), {"run", "small.toml", "-o", "killed", "--set", "procedure.positions=360"}, "killed");
  while (run.Runs() && !Exists("killed/scenario.toml")) std::this_thread::sleep_for(milliseconds(1));
  run.Kill();
  const Outcome outcome = Call({"diagnose", "killed", "--follow", "--scenario", "small.toml"});
  ExpectEnded(outcome, 1, {"the program that wrote this run ended before it was complete"});
  EXPECT_THAT(outcome.out, HasSubstr("not complete"));
}

}  // namespace
}  // namespace twinbench::test
