#include "tests/tools/program.h"

#include "tests/campaign/small_study.h"
#include "twin/core/sqlite_database.h"

namespace twinbench::test {
namespace {

using testing::AllOf, testing::HasSubstr;

const std::string kMpirun = TWINBENCH_MPIRUN;

constexpr const char* kVaried = R"(trials = 20
sampling = "latin_hypercube"
[[vary]]
key = "device.noise_deg"
distribution = "log_uniform"
lower = 0.0005
upper = 0.005
)";

/// `twinbench campaign` as its users meet it.
class CampaignProgram : public Program {
 protected:
  CampaignProgram() { Write("study.toml", campaign::StudyOf(kVaried)); }

  void MakeTable(const std::string& name, const std::vector<std::string>& options = {}) {
    Succeed(With({"campaign", "study.toml", "-o", name}, options));
  }

  /// All that a table holds, in the order of its keys.
  std::string Dump(const std::string& name) const {
    SqliteDatabase table(At(name), SQLITE_OPEN_READWRITE);
    std::string text;
    for (const auto& [sql, columns] :
         {std::pair{"SELECT * FROM provenance ORDER BY name", 2},
          std::pair{"SELECT * FROM trials ORDER BY trial", 5},
          std::pair{
              "SELECT trial, name, printf('%!.17g', value), printf('%!.17g', u), printf('%!.17g', error) FROM "
              "results ORDER BY trial, name",
              5}}) {
      SqliteStatement ask(table, sql);
      while (ask.Step()) {
        for (int column = 0; column < columns; ++column) text += ask.Text(column) + "|";
        text += "\n";
      }
    }
    return text;
  }

  /// @return the exit code.
  int OnRanks(const std::string& ranks, const std::string& name) const {
    const std::string program = std::string(TWINBENCH_PROGRAM) + " campaign study.toml -o " + name;
    const std::string command =
        "cd '" + At("") + "' && timeout 300 '" + kMpirun + "' -n " + ranks + " " + program + " > mpi.out 2> mpi.err";
    return WEXITSTATUS(std::system(command.c_str()));
  }

  std::string Ask(const std::string& name, const char* sql) const {
    return SqliteDatabase(At(name), SQLITE_OPEN_READWRITE).Ask(sql);
  }
};

TEST_F(CampaignProgram, MakesTheSameTableOnAnyNumberOfThreads) {
  for (const char* threads : {"1", "2", "5"}) MakeTable(threads, {"--threads", threads});
  EXPECT_EQ(Ask("1", "SELECT count(*) FROM trials WHERE failure = ''"), "20");
  EXPECT_GT(std::stoi(Ask("1", "SELECT count(error) FROM results")), 20);
  for (const char* threads : {"2", "5"}) EXPECT_EQ(Dump("1"), Dump(threads)) << threads;
}

TEST_F(CampaignProgram, MakesTheSameTableOnTwoRanks) {
  if (kMpirun.empty()) GTEST_SKIP() << "this build has no MPI";
  MakeTable("alone.sqlite", {"--threads", "1"});
  for (const char* ranks : {"2", "3"}) {
    const std::string name = std::string("ranks") + ranks + ".sqlite";
    ASSERT_EQ(OnRanks(ranks, name), 0) << Read("mpi.err");
    EXPECT_EQ(Dump("alone.sqlite"), Dump(name));
  }
}

TEST_F(CampaignProgram, SaysOnceWhatIsWrongToAllRanks) {
  if (kMpirun.empty()) GTEST_SKIP() << "this build has no MPI";
  Write("study.toml", campaign::StudyOf("trails = 4\n"));
  EXPECT_EQ(OnRanks("2", "t.sqlite"), 2) << Read("mpi.err");
  const std::string said = Read("mpi.err"), once = "study.toml:12: ";
  EXPECT_EQ(said.find(once), said.rfind(once));
  EXPECT_NE(said.find(once), std::string::npos);
}

TEST_F(CampaignProgram, GoesOnAfterAKillAsIfNothingHadHappened) {
  Write("study.toml", campaign::StudyOf("trials = 60\n"));
  MakeTable("undisturbed.sqlite", {"--threads", "2"});
  int cut_short = 0;
  for (const int tenths : {1, 4, 2}) {
    Process run(At(""), {"campaign", "study.toml", "-o", "killed.sqlite", "--threads", "2", "--resume"});
    while (run.Runs() && run.ProgressLines() < tenths) std::this_thread::yield();
    if (!run.Runs()) continue;
    run.Kill();
    ++cut_short;
  }
  EXPECT_GE(cut_short, 2) << "the kills came too late to show anything";
  const int kept = std::stoi(Ask("killed.sqlite", "SELECT count(*) FROM trials"));
  EXPECT_GT(kept, 10);
  EXPECT_LT(kept, 60);
  MakeTable("killed.sqlite", {"--resume"});
  EXPECT_EQ(Dump("undisturbed.sqlite"), Dump("killed.sqlite"));
}

TEST_F(CampaignProgram, DoesNotOverwriteATableOrGoOnWithAnotherStudy) {
  MakeTable("t.sqlite", {});
  const std::string before = Dump("t.sqlite");
  EXPECT_THAT(Call({"campaign", "study.toml", "-o", "t.sqlite"}).err, HasSubstr("--resume"));
  Write("study.toml", campaign::StudyOf("trials = 21\n"));
  const Outcome other = Call({"campaign", "study.toml", "-o", "t.sqlite", "--resume"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("another study"));
  EXPECT_EQ(Dump("t.sqlite"), before);
}

TEST_F(CampaignProgram, LosesOneRowWithATrialThatFailsAndSaysWhy) {
  // The interpolation error goes by the lines of the scale: without lines the twin cannot be built.
  Write("study.toml", campaign::StudyOf(R"(trials = 2
set = ['effect=[{name = "interpolation"}]']
[[vary]]
key = "device.lines_per_turn"
values = [1024, 0, 2048]
)"));
  MakeTable("t.sqlite", {});
  EXPECT_EQ(Ask("t.sqlite",
                "SELECT group_concat(trial) FROM (SELECT trial FROM trials WHERE failure <> '' ORDER BY "
                "trial)"),
            "2,3");
  EXPECT_THAT(Ask("t.sqlite", "SELECT failure FROM trials WHERE trial = 2"), HasSubstr("needs the lines"));
  EXPECT_EQ(Ask("t.sqlite", "SELECT count(*) FROM results WHERE trial IN (2, 3)"), "0");
  EXPECT_EQ(Ask("t.sqlite", "SELECT count(DISTINCT trial) FROM results"), "4");
  EXPECT_EQ(
      Ask("t.sqlite", "SELECT group_concat(\"device.lines_per_turn\") FROM (SELECT * FROM trials ORDER BY trial)"),
      "1024,1024,0,0,2048,2048");
}

TEST_F(CampaignProgram, ShowsATrialAgainAsAnOrdinaryScenario) {
  MakeTable("t.sqlite", {});
  Write("trial.toml", Succeed({"campaign", "study.toml", "--trial", "17"}));
  Succeed({"run", "trial.toml", "-o", "again"});
  const nlohmann::json results = nlohmann::json::parse(Read("again/results.json"));
  EXPECT_EQ(std::stod(Ask("t.sqlite",
                          "SELECT printf('%!.17g', value) FROM results WHERE trial = 17 AND name = "
                          "'device.ez_arcsec[3]'")),
            results["device"]["ez_arcsec"][3].get<double>());
}

TEST_F(CampaignProgram, KeepsTheVerdictOfADiagnosisThatDoesNotKnowWhatIsHidden) {
  Write("study.toml", campaign::StudyOf(R"(diagnosis = true
set = ["encoder_procedure.turns=2", "device.noise_known=true"]
[[vary]]
key = "effect"
hidden = true
values = ['[]', '[{name = "eccentricity"}]']
)"));
  MakeTable("t.sqlite", {});
  EXPECT_EQ(Ask("t.sqlite", "SELECT verdict FROM trials WHERE trial = 0"), "none");
  EXPECT_THAT(Ask("t.sqlite", "SELECT verdict FROM trials WHERE trial = 1"), testing::AnyOf("named", "tie"));
  EXPECT_EQ(Ask("t.sqlite", "SELECT trial FROM results WHERE name LIKE 'diagnosis.%.probability'"), "1");
  EXPECT_EQ(Ask("t.sqlite", "SELECT abs(value - 0.01) < 4.0 * u FROM results WHERE name = 'diagnosis.eccentricity[0].amplitude_deg'"), "1");
}

TEST_F(CampaignProgram, WritesALineATrial) {
  MakeTable("t.sqlite", {"--csv", "t.csv"});
  const std::string csv = Read("t.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 21);
  EXPECT_THAT(csv, testing::StartsWith("trial,seed,failure,verdict,device.noise_deg,"));
  EXPECT_THAT(csv, AllOf(HasSubstr("device.ez_arcsec[3],u(device.ez_arcsec[3])"),
                         HasSubstr("error(score.device.ez_arcsec[3])")));
}

}  // namespace
}  // namespace twinbench::test
