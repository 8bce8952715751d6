#include <gmock/gmock.h>

#include <chrono>
#include <thread>

#include "tests/tools/program_here.h"
#include "twin/core/run_record.h"

/// What somebody tried who wanted to see it break, or mistyped.
namespace twinbench::test {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

class Attack : public ProgramHere {
 protected:
  Attack() { Write("small.toml", kSmall); }

  /// @return what it complains about; the folder must be as it was.
  std::string Refusal(const std::vector<std::string>& arguments) {
    const auto before = Snapshot();
    const Outcome outcome = Call(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_TRUE(before == Snapshot()) << "the folder has changed";
    return outcome.err;
  }
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

TEST_F(Attack, KeysWithoutEndAreRefusedInEveryFile) {
  Write("bad.toml", kSmall + Dotted(100000) + "\n");
  EXPECT_THAT(Refusal({"run", "bad.toml", "-o", "out"}), HasSubstr(": a key of 100001 parts; expected at most 64"));
  Write("bench.toml", "kind = \"twin\"\n" + std::string(200000, 'k') + "= 1\n");
  EXPECT_THAT(Refusal({"measure", "small.toml", "--bench", "bench.toml", "-o", "out"}),
              HasSubstr("bench.toml:2: a key of 200000 letters"));
  EXPECT_THAT(Refusal({"run", "small.toml", "-o", "out", "--set", Dotted(1000)}), HasSubstr("a key of 1001 parts"));
}

TEST_F(Attack, AWatchWithoutEndIsRefusedAndNotCountedWrongly) {
  EXPECT_THAT(Refusal({"run", "small.toml", "-o", "out", "--set", "procedure.stability_s=1e8", "--set",
                       "procedure.stability_interval_s=0.01"}),
              HasSubstr("1e+08 s of stability every 0.01 s are 1e+10 readings"));
}

TEST_F(Attack, ARunOverwritesNoFileOfTheUser) {
  Write("scenario.toml", kSmall);
  EXPECT_THAT(Refusal({"run", "scenario.toml", "-o", "."}), HasSubstr("scenario.toml: the file is there already"));
  Write("bench.toml", "kind = \"twin\"\n");
  EXPECT_THAT(Refusal({"measure", "small.toml", "--bench", "bench.toml", "-o", "."}),
              HasSubstr("scenario.toml: the file is there already"));
}

TEST_F(Attack, AnOutputIsNoInputAndNoRecord) {
  MakeRun("run");
  EXPECT_THAT(Refusal({"export", "run", "--readings", "run/record.sqlite"}), HasSubstr("this is a record"));
  Succeed({"export", "run", "--readings", "readings.csv"});
  for (const char* output : {"small.toml", "readings.csv", "./small.toml"})
    EXPECT_THAT(Refusal({"separate", "readings.csv", "--scenario", "small.toml", "--json", output}),
                HasSubstr("reads this file and would overwrite it"));
  EXPECT_THAT(Refusal({"diagnose", "readings.csv", "--scenario", "small.toml", "-o", "small.toml"}),
              HasSubstr("reads this file"));
  EXPECT_THAT(Refusal({"export", "run", "--readings", "run"}), HasSubstr("this is a folder"));
}

TEST_F(Attack, WhatIsThereStaysUnlessForceIsSaid) {
  MakeRun("run");
  Write("notes.txt", "three weeks of work");
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
           {"export", "run", "--readings", "notes.txt"},
           {"new", "rotary_4dof", "-o", "notes.txt"},
           {"plan", "small.toml", "-o", "notes.txt"},
           {"certificate", "--template", "-o", "notes.txt"},
           {"serve", "small.toml", "--write-bench", "notes.txt"}})
    EXPECT_THAT(Refusal(command), HasSubstr("notes.txt: the file is there already; expected a name that is not taken, or --force"))
        << command.front();
  Succeed({"export", "run", "--readings", "notes.txt", "--force"});
  EXPECT_EQ(Read("notes.txt"), ReadingsOf("run"));
  Write("place", "");  // made by somebody who wanted a name of his own
  Succeed({"new", "rotary_4dof", "-o", "place"});
}

TEST_F(Attack, OnlyARunOfTheTwinIsMadeAgain) {
  MakeRun("run");
  const std::string before = ReadingsOf("run");
  EXPECT_THAT(Refusal({"run", "small.toml", "-o", "run", "--seed", "6"}), HasSubstr("--force to make the twin's run again"));
  Succeed({"run", "small.toml", "-o", "run", "--seed", "6", "--force"});
  EXPECT_NE(ReadingsOf("run"), before);
  Succeed({"export", "run", "--readings", "readings.csv"});
  Succeed({"import", "readings.csv", "--scenario", "small.toml", "-o", "imported"});
  EXPECT_THAT(Refusal({"run", "small.toml", "-o", "imported", "--force"}), HasSubstr("cannot be made again; --force is not for it"));
  Write("scenario.toml", kSmall);
  EXPECT_THAT(Refusal({"run", "scenario.toml", "-o", ".", "--force"}), HasSubstr("reads this file and would overwrite it"));
}

TEST_F(Attack, ADiskThatIsFullIsNoSuccess) {
  MakeRun("run");
  EXPECT_EQ(ExitOfShell("export run > /dev/full"), 1);
  EXPECT_EQ(ExitOfShell("export run --readings /dev/full"), 1);
  EXPECT_EQ(ExitOfShell("separate run > /dev/full"), 1);
  EXPECT_EQ(ExitOfShell("separate run --json /dev/full"), 1);
  EXPECT_EQ(ExitOfShell("score run > /dev/full"), 1);
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
  EXPECT_THAT(anew.out, HasSubstr("there is no run in tuesday to resume; a new one begins"));
  RunRecord::Create(At("monday"), {"test", "twin", 5, "", "rotary_4dof"});  // begun, and ended before its first reading
  EXPECT_EQ(Refusal(measure("mondya")),
            "twinbench: --resume: there is no run in mondya; expected the folder of a run that was begun, perhaps "
            "monday; without --resume a new one is\n");
}

TEST_F(Attack, WhoFollowsARunThatWasKilledIsTold) {
  Process run(At(""), {"run", "small.toml", "-o", "killed", "--set", "procedure.positions=360"}, "killed");
  while (run.Runs() && !Exists("killed/scenario.toml")) std::this_thread::sleep_for(milliseconds(1));
  run.Kill();
  const Outcome outcome = Call({"diagnose", "killed", "--follow", "--scenario", "small.toml"});
  EXPECT_EQ(outcome.exit_code, 1) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("not complete"));
  EXPECT_THAT(outcome.err, HasSubstr("the program that wrote this run ended before it was complete"));
}

}  // namespace
}  // namespace twinbench::test
