#include <random>

#include "tests/tools/program_here.h"
#include "tools/twinbench/measured_run.h"

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

TEST_F(ResumedRun, CountsAnAttemptAtTheReadingThatWasUnderWayAndIsEvaluatedAndNotOverwrittenBefore) {
  Process run(At(""), Measure("killed"));
  run.Await(4);
  run.Kill();
  const auto kept = static_cast<int>(Kept("killed"));
  ASSERT_GT(kept, 0);
  ASSERT_LT(kept, kReadings);
  Refusal({"run", "long.toml", "-o", "killed"});
  const Outcome evaluated = Call({"separate", "killed", "--json", "-"});  // as far as it got
  EXPECT_TRUE(evaluated.exit_code == 0 || evaluated.err.find("; expected ") != std::string::npos) << evaluated.err;
  Succeed(Measure("killed"));
  const auto attempts = RunRecord::Open(At("killed"))->FailedAttempts();
  ASSERT_EQ(attempts.size(), 1u);
  EXPECT_EQ(attempts[0].reading, kept);
  EXPECT_EQ(attempts[0].attempt, 1);
  EXPECT_EQ(attempts[0].fault, "interrupted");
}

TEST_F(ResumedRun, OfAnotherScenarioOrWithoutResumeIsRefusedAndTheFolderNotTouched) {
  const auto words = Measure("undisturbed");
  ExpectRefused({words.begin(), words.end() - 1});
  ExpectRefused(With(words, {"--set", "procedure.positions=12"}));
  EXPECT_EQ(ReadingsOf("undisturbed"), readings_);
}

TEST_F(ResumedRun, BehindReadingsOfTwoStatesIsRefused) {
  Process run(At(""), Measure("jumped"));
  run.Await(4);
  run.Kill();
  RunRecord::Continue(At("jumped"))->AttemptFailed(40, {}, "changed", "measure again, in another run");
  EXPECT_THAT(Refusal(Measure("jumped")), testing::HasSubstr("measure again, in another run"));
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

// How long ago a run began, told by a record and by what a computer's clocks show when it is taken up again.

using testing::ElementsAre, testing::HasSubstr;

const ClockMark kBegun{"a-b-c", 5000.0, 1.7e9};

/// A run of which one reading was kept 100 s behind its begin, and then it was killed.
struct RunToTakeUp {
  RunToTakeUp() {
    begun.record = RunRecord::Create(folder.path(), {"test", "iio:bench", 1, "2023-11-14T22:13:20Z", "rotary_4dof"});
    begun.record->AppendEvent(Time{}, "clock", TextOf(kBegun));
    Reading kept;
    kept.time = Time(std::chrono::seconds(100));
    begun.record->Append(kept, {});
    begun.readings = {kept};
  }
  /// Behind the one that says when the run began.
  std::vector<std::string> Notes() const {
    std::vector<std::string> texts;
    for (const RecordedEvent& event : begun.record->Events()) texts.push_back(event.text);
    texts.erase(texts.begin());
    return texts;
  }

  TemporaryFolder folder;
  tools::BegunRun begun;
};

TEST(BegunRun, MayHaveLostZerosWhereItsLastAttemptsSaySo) {
  const TemporaryFolder folder;
  tools::BegunRun begun{RunRecord::Create(folder.path(), {}), std::vector<Reading>(3)};
  const auto behind = [&](int reading, const char* fault, const char* text) {
    begun.record->AttemptFailed(reading, {}, fault, text);
    return tools::MayHaveLostZeros(begun);
  };
  EXPECT_FALSE(behind(2, "refused", "target: has lost its origin"));  // and found it
  EXPECT_FALSE(behind(3, "timeout", "target: no answer"));
  EXPECT_FALSE(behind(3, "implausible", "thermometer: 90 degC"));
  EXPECT_TRUE(behind(3, "implausible", "target: somebody set its zero anew"));
  begun.readings.resize(4);
  EXPECT_FALSE(tools::MayHaveLostZeros(begun));
  EXPECT_TRUE(behind(4, "refused", "target: has lost its origin"));
}

TEST(ResumedTime, IsNotMovedByAWallClockThatWasSetBetweenKillAndResume) {
  for (const double set_s : {0.0, 86400.0, -86400.0}) {
    const RunToTakeUp run;
    EXPECT_EQ(tools::SinceBegin(run.begun, {"a-b-c", 5160.5, 1.7e9 + 160.5 + set_s}), FromSeconds(160.5));
    if (set_s == 0.0) {
      EXPECT_TRUE(run.Notes().empty());
    } else {
      EXPECT_THAT(run.Notes(), ElementsAre(HasSubstr(set_s > 0.0 ? "set by +86400.0 s" : "set by -86400.0 s")));
    }
  }
}

TEST(ResumedTime, BehindARestartGoesByTheWallClockAndSaysSoButNeverBack) {
  const RunToTakeUp later, back;
  EXPECT_EQ(tools::SinceBegin(later.begun, {"d-e-f", 20.0, 1.7e9 + 700.0}), FromSeconds(700.0));
  EXPECT_EQ(tools::SinceBegin(back.begun, {"d-e-f", 20.0, 1.7e9 - 3600.0}), FromSeconds(100.0)) << "behind its last reading";
  for (const RunToTakeUp* run : {&later, &back}) EXPECT_THAT(run->Notes(), ElementsAre(HasSubstr("started anew")));
}

}  // namespace
}  // namespace twinbench::test
