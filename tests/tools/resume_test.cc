
#include <cstdlib>
#include <random>
#include <set>

#include "tests/support/night.h"
#include "tests/tools/program_here.h"
#include "twin/core/run_record.h"

/// Runs that are broken off at any moment and taken up again by another process.
namespace twinbench::test {
namespace {

using std::chrono::duration, std::chrono::steady_clock;

constexpr int kReadings = 2 * 2 * 13 + 4 * 4 * 24;  // sweeps, then circles

class ResumedRun : public ProgramHere {
 protected:
  ResumedRun() {
    static duration<double> lasts{};
    BeginWith("resume", [this] {
      Write("own.toml", "kind = \"twin\"\n");
      // Everything random, so that a state that is not restored shows.
      Write("long.toml",
            "bench = \"rotary_4dof\"\nseed = 77\n[mechanics]\nfidelity = \"kinematic\"\n[procedure]\npositions = "
            "24\n[target.repeatability]\nex_arcsec = 1.0\n"
            "[reference.seating]\nez_arcsec = 20.0\n[environment]\ndrift_K_h = 1.0\nrandom_walk_K_sqrt_h = 0.1\n");
      const auto start = steady_clock::now();
      Succeed(Measure("undisturbed"));
      lasts = steady_clock::now() - start;
    });
    duration_ = lasts;
    readings_ = ReadingsOf("undisturbed");
  }

  /// Goes on where there is a run.
  std::vector<std::string> Measure(const std::string& name) const {
    std::vector<std::string> words = {"measure", "long.toml", "--bench", "own.toml", "-o", name};
    if (Exists(name)) words.push_back("--resume");
    return words;
  }

  /// Starts or takes up a run and kills it: behind so many lines of its progress, of which a resumed one has one at its first reading and
  /// one each tenth, or, of none, within its start; and a random moment later.
  /// @return whether it was killed before it was done.
  bool KillOnce(const std::string& name, int lines) {
    Process run(At(""), Measure(name));
    run.Await(lines);
    std::this_thread::sleep_for(std::uniform_real_distribution<>(0.0, lines == 0 ? 0.6 : 0.1)(random_) * duration_);
    if (!run.Runs()) return false;
    run.Kill();
    return true;
  }

  std::size_t Kept(const std::string& name) const {
    return Exists(name + "/record.sqlite") ? RunRecord::Open(At(name))->Readings().size() : 0;
  }

  duration<double> duration_{};
  std::string readings_;
  std::mt19937_64 random_{2007};
};

/// More of them by hand: TWINBENCH_KILLS=500.
int KillsWanted() {
  const char* wanted = std::getenv("TWINBENCH_KILLS");
  return wanted ? std::atoi(wanted) : 12;
}

TEST_F(ResumedRun, IsTheUndisturbedOneHoweverOftenItIsKilled) {
  int kills = 0, runs = 0;
  std::set<std::size_t> moments;
  while (kills < KillsWanted()) {
    const std::string name = "killed" + std::to_string(runs++);
    std::size_t kept = 0;
    while (KillOnce(name, kills % 4)) {
      ++kills;
      const std::size_t now = Kept(name);
      ASSERT_GE(now, kept) << "what was kept once stays";
      kept = now;
      moments.insert(kept);
    }
    Succeed(Measure(name));
    ASSERT_EQ(ReadingsOf(name), readings_) << "after kill " << kills;
    ASSERT_EQ(Read(name + "/results.json"), Read("undisturbed/results.json"));
  }
  EXPECT_GE(moments.size(), static_cast<std::size_t>(kills / 4)) << "they should come at different moments";
}

TEST_F(ResumedRun, CountsAnAttemptAtTheReadingThatWasUnderWay) {
  Process run(At(""), Measure("killed"));
  run.Await(4);
  run.Kill();
  const auto kept = static_cast<int>(Kept("killed"));
  ASSERT_GT(kept, 0);
  ASSERT_LT(kept, kReadings);
  Succeed(Measure("killed"));
  const auto attempts = RunRecord::Open(At("killed"))->FailedAttempts();
  ASSERT_EQ(attempts.size(), 1u);
  EXPECT_EQ(attempts[0].reading, kept);
  EXPECT_EQ(attempts[0].attempt, 1);
  EXPECT_EQ(attempts[0].fault, "interrupted");
}

TEST_F(ResumedRun, AfterCtrlCGoesOnWhereItWasStopped) {
  {
    Process run(At(""), Measure("stopped"));
    run.Await(4);
    run.Signal(SIGINT);
    const Outcome outcome = run.Wait();
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.err, testing::HasSubstr("stopped"));
    EXPECT_THAT(outcome.err, testing::HasSubstr("--resume"));
  }
  EXPECT_LT(Kept("stopped"), std::size_t{kReadings});
  EXPECT_EQ(RunRecord::Open(At("stopped"))->FailedAttempts().back().fault, "stopped");
  Succeed(Measure("stopped"));
  EXPECT_EQ(ReadingsOf("stopped"), readings_);
}

TEST_F(ResumedRun, OfAnotherScenarioOrWithoutResumeIsRefusedAndTheFolderNotTouched) {
  auto words = Measure("undisturbed");
  ExpectRefused({words.begin(), words.end() - 1});
  words.insert(words.end(), {"--set", "procedure.positions=12"});
  ExpectRefused(words);
  EXPECT_EQ(ReadingsOf("undisturbed"), readings_);
}

TEST_F(ResumedRun, IsNeverWrittenByTwo) {
  Process first(At(""), Measure("shared"));
  first.Await(1);
  const Outcome second = Call(Measure("shared"));
  if (first.Runs()) {
    EXPECT_EQ(second.exit_code, 2);
    EXPECT_THAT(second.err, testing::HasSubstr("another program is writing"));
  }
  first.Wait();
  EXPECT_EQ(ReadingsOf("shared"), readings_);
}

TEST_F(ResumedRun, PlaysARecordingBackToTheSameReadings) {
  Write("replay.toml", "kind = \"replay\"\nrecord = \"undisturbed\"\n");
  Succeed({"measure", "long.toml", "--bench", "replay.toml", "-o", "played"});
  EXPECT_EQ(ReadingsOf("played"), readings_);
  const Outcome other =
      Call({"measure", "long.toml", "--bench", "replay.toml", "-o", "other", "--set", "procedure.dwell_s=[3.0]"});
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_THAT(other.err, testing::HasSubstr("is not in the recording"));
  EXPECT_THAT(other.err, testing::Not(testing::HasSubstr("stand")));  // nothing was asked of tables
}

/// Runs that are killed in the middle.
class KilledRun : public ProgramHere {
 protected:
  KilledRun() {
    static duration<double> lasts{};
    BeginWith("kill", [this] {
      // 2 * 13 + 2 * 13 + 4 * 36 * 16 = 2356 readings, one transaction each; so few positions are soon separated.
      std::string passes = "1";
      for (int k = 1; k < 16; ++k) passes += k % 2 == 1 ? ", -1" : ", 1";
      Write("long.toml", "bench = \"rotary_4dof\"\n[mechanics]\nfidelity = \"kinematic\"\n[procedure]\npositions = 36\npasses = [" +
                             passes + "]\n");
      const auto start = steady_clock::now();
      Succeed({"run", "long.toml", "-o", "undisturbed"});
      lasts = steady_clock::now() - start;
    });
    duration_ = lasts;
    readings_ = ReadingsOf("undisturbed");
  }

  /// Kills a run after so many of the ten lines of progress that it writes, and some moments later.
  void KillAfterTenths(int tenths, const std::string& name) {
    Process run(At(""), {"run", "long.toml", "-o", name});
    run.Await(tenths);
    std::this_thread::sleep_for(std::uniform_real_distribution<>(0.0, 0.05)(random_) * duration_);
    if (run.Runs()) run.Kill();
  }

  /// @return how many lines `text` has, all of them whole lines at the beginning of the undisturbed readings.
  std::ptrdiff_t ExpectPrefix(const std::string& text) const {
    EXPECT_TRUE(text.ends_with('\n'));
    const std::ptrdiff_t lines = std::count(text.begin(), text.end(), '\n');
    // Columns of what came along with readings - where encoders stood - are there from the first reading on.
    const std::size_t compared = lines == 1 ? text.size() - 1 : text.size();
    EXPECT_EQ(text.substr(0, compared), readings_.substr(0, compared));
    return lines;
  }

  duration<double> duration_{};
  std::string readings_;
  std::mt19937_64 random_{2007};
};

TEST_F(KilledRun, HoldsAPrefixOfTheUndisturbedRunByteForByte) {
  int cut_short = 0;
  std::set<std::ptrdiff_t> lengths;
  const int moments = ByNight(10, 5);
  for (int moment = 0; moment < moments; ++moment) {
    const std::string name = "killed" + std::to_string(moment);
    KillAfterTenths(1 + moment % 7, name);
    const std::ptrdiff_t lines = ExpectPrefix(Succeed({"export", name}));
    lengths.insert(lines);
    if (lines < std::count(readings_.begin(), readings_.end(), '\n')) ++cut_short;
  }
  // On a busy machine a kill may come late, but not most of them.
  EXPECT_GT(cut_short, moments / 2) << "the kills came too late to show anything";
  EXPECT_GT(std::ssize(lengths), moments / 2);
}

TEST_F(KilledRun, AtItsVeryStartHasNoRecordOrAGoodOne) {
  for (int moment = 0; moment < 10; ++moment) {
    const std::string name = "killed" + std::to_string(moment);
    {
      const Process run(At(""), {"run", "long.toml", "-o", name});
      std::this_thread::sleep_for(std::chrono::milliseconds(2 * moment));  // at its end it is killed
    }
    const Outcome outcome = Call({"export", name});
    if (outcome.exit_code == 0) {
      ExpectPrefix(outcome.out);
    } else {
      // A record appears whole or not at all; without one that is said in one line, as bad input.
      EXPECT_FALSE(Exists(name + "/record.sqlite"));
      EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
      EXPECT_THAT(outcome.err, testing::HasSubstr(name));
    }
  }
}

TEST_F(KilledRun, CanStillBeEvaluatedAsFarAsItGotAndIsNotOverwrittenByTheNext) {
  KillAfterTenths(7, "killed");
  const Outcome outcome = Call({"separate", "killed", "--json", "-"});
  EXPECT_TRUE(outcome.exit_code == 0 || outcome.err.find("; expected ") != std::string::npos) << outcome.err;
  EXPECT_TRUE(Exists("killed/scenario.toml"));
  Refusal({"run", "long.toml", "-o", "killed"});
}

}  // namespace
}  // namespace twinbench::test
