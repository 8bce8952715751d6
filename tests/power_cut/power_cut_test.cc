#include "tests/power_cut/numbered.h"
#include "tests/power_cut/write_log.h"
#include "tests/support/night.h"
#include "tests/tools/program.h"

namespace twinbench::test {
namespace {

constexpr int kReadings = 250;

/// Runs the writer with every change of its files written down.
std::vector<FileChange> ChangesOfAWriter(const std::string& how) {
  const TemporaryFolder folder;
  const std::string run = folder.File("run"), log = folder.File("log");
  const std::string command = "TWINBENCH_DISK_ROOT=" + run + " TWINBENCH_DISK_LOG=" + log +
                              " LD_PRELOAD=" POWER_CUT_DISK " " POWER_CUT_WRITER " " + run + " " +
                              std::to_string(kReadings) + how;
  if (std::system(command.c_str()) != 0) throw BenchError("the writer failed: " + command);
  return ReadWriteLog(log);
}

/// Of the writer that waits for the disk, once for all tests here.
const std::vector<FileChange>& WritersChanges() {
  static const std::vector<FileChange> changes = ChangesOfAWriter("");
  return changes;
}

int SyncsOfTheLog(const std::vector<FileChange>& changes) {
  return static_cast<int>(std::ranges::count_if(
      changes, [](const FileChange& change) { return change.what == 's' && change.path.ends_with("-wal"); }));
}

std::string NameOf(const std::string& path) {
  return std::filesystem::path(path).filename();
}

/// Lays a disk's files into a folder; the shared memory of the log does not outlive a power cut.
void LayOut(const std::map<std::string, std::string>& files, const TemporaryFolder& folder) {
  for (const auto& [path, content] : files) {
    if (!path.ends_with("-shm") && NameOf(path) != "acknowledged") folder.Write(NameOf(path), content);
  }
}

/// @return how many readings the record in `folder` holds; each must be whole and the ones before it there.
int IntactReadings(const TemporaryFolder& folder) {
  if (!std::filesystem::exists(folder.File("record.sqlite"))) return 0;
  const auto record = RunRecord::Open(folder.path());
  const std::vector<Reading> readings = record->Readings();
  const std::vector<RawBlock> blocks = record->RawBlocks();
  const std::vector<DeviceCall> calls = record->Calls();
  EXPECT_EQ(blocks.size(), readings.size()) << "a reading without its block";
  EXPECT_EQ(calls.size(), readings.size()) << "a reading without its calls";
  for (int k = 0; k < static_cast<int>(readings.size()); ++k) {
    const auto at = static_cast<std::size_t>(k);
    const Reading expected = NumberedReading(k);
    EXPECT_EQ(readings[at].reading, k);
    EXPECT_EQ(readings[at].mean_V, expected.mean_V);
    EXPECT_EQ(readings[at].time, expected.time);
    EXPECT_EQ(blocks[at].samples, NumberedBlock(k).raw);
    EXPECT_EQ(calls[at].answer, std::to_string(k));
  }
  return static_cast<int>(readings.size());
}

class PowerCut : public ::testing::TestWithParam<ForgetfulDisk::Left> {};

TEST_P(PowerCut, AtAnyMomentLosesNothingThatWasAcknowledged) {
  const std::vector<FileChange>& changes = WritersChanges();
  std::mt19937_64 random(2007);
  std::vector<std::size_t> moments(static_cast<std::size_t>(test::ByNight(300, 60)));
  for (std::size_t& moment : moments)
    moment = std::uniform_int_distribution<std::size_t>(0, changes.size())(random);
  std::sort(moments.begin(), moments.end());

  ForgetfulDisk disk;
  std::size_t done = 0;
  int acknowledged = 0, with_readings = 0;
  for (const std::size_t moment : moments) {
    for (; done < moment; ++done) {
      if (NameOf(changes[done].path) == "acknowledged" && changes[done].what == 'w') ++acknowledged;
      disk.Apply(changes[done]);
    }
    const TemporaryFolder folder;
    LayOut(disk.AfterPowerCut(GetParam(), random), folder);
    const int intact = IntactReadings(folder);
    ASSERT_GE(intact, acknowledged) << "power cut after change " << moment;
    ASSERT_LE(intact, acknowledged + 1) << "at most the one that was being kept";
    if (intact > 0) ++with_readings;
  }
  EXPECT_GT(with_readings, std::ssize(moments) * 5 / 6) << "nearly all moments lie within the run";
}

TEST_P(PowerCut, OfARunThatSparesTheDiskLosesItsLatestReadingsAndNoneOnceItIsFinished) {
  const std::vector<FileChange> changes = ChangesOfAWriter(" sparing");
  EXPECT_LT(SyncsOfTheLog(changes), kReadings / 10) << "the disk is not spared";
  std::mt19937_64 random(2007);
  ForgetfulDisk disk;
  const auto intact = [&] {  // a whole record of the first so many, whenever it was
    const TemporaryFolder folder;
    LayOut(disk.AfterPowerCut(GetParam(), random), folder);
    return IntactReadings(folder);
  };
  bool finished = false;
  for (std::size_t done = 0; done < changes.size(); ++done) {
    disk.Apply(changes[done]);
    finished = finished || (NameOf(changes[done].path) == "acknowledged" && changes[done].what == 'w');
    if (finished) {
      ASSERT_EQ(intact(), kReadings) << "power cut after change " << done;
    } else if (done % 97 == 0) {
      EXPECT_GE(intact(), 0);
    }
  }
  EXPECT_TRUE(finished);
}

INSTANTIATE_TEST_SUITE_P(Disk, PowerCut,
                         ::testing::Values(ForgetfulDisk::Left::kPrefix, ForgetfulDisk::Left::kTornSubset),
                         [](const auto& left) {
                           return left.param == ForgetfulDisk::Left::kPrefix ? "KeepsAPrefix" : "KeepsATornSubset";
                         });

TEST(ForgetfulDisk, KeepsWhatWasSyncedAndForgetsTheRest) {
  // Guards the tests above: a disk that keeps everything would pass them.
  ForgetfulDisk disk;
  const FileChange changes[] = {{'c', "/d/f", 0, ""}, {'w', "/d/f", 0, "kept"}, {'s', "/d/f", 0, ""},
                                {'s', "/d", 0, ""},   {'w', "/d/f", 0, "lost"}, {'c', "/d/g", 0, ""}};
  for (const FileChange& change : changes) disk.Apply(change);
  std::mt19937_64 random(1);
  int old_content = 0, second_file = 0;
  for (int k = 0; k < 200; ++k) {
    const auto files = disk.AfterPowerCut(ForgetfulDisk::Left::kPrefix, random);
    ASSERT_TRUE(files.contains("/d/f"));
    if (files.at("/d/f") == "kept") ++old_content;
    if (files.contains("/d/g")) ++second_file;
  }
  EXPECT_NEAR(old_content, 100, 40);  // 200 throws of a coin: 7 standard deviations are 50
  EXPECT_NEAR(second_file, 100, 40);
}

TEST(WriteLog, SawTheWriterSyncEveryReading) {
  const bool checkpointed = std::ranges::any_of(WritersChanges(), [](const FileChange& change) {
    return change.what == 'w' && change.path.ends_with("record.sqlite");
  });
  EXPECT_GE(SyncsOfTheLog(WritersChanges()), kReadings);
  EXPECT_TRUE(checkpointed) << "the log was never folded into the database";
}

/// A run on a disk that runs full in the middle, and the same run taken up when there is room again.
class FullDisk : public Program {
 protected:
  FullDisk() {
    Write("own.toml", "kind = \"twin\"\n");
    Write("raw.toml", "bench = \"rotary_4dof\"\nmechanics.fidelity = \"kinematic\"\nadc.samples = 1000\n"
                      "procedure.keep_raw = true\n");
    Succeed(Measure("undisturbed"));
  }
  /// Goes on where there is a run.
  std::vector<std::string> Measure(const std::string& name) const {
    std::vector<std::string> words = {"measure", "raw.toml", "--bench", "own.toml", "-o", name};
    if (Exists(name)) words.push_back("--resume");
    return words;
  }

  /// @param tells  Whether the file system says how much room is left.
  Outcome MeasureWithRoom(const std::string& name, const char* room_B, bool tells) {
    setenv("TWINBENCH_DISK_ROOT", At(name).c_str(), 1);
    setenv("TWINBENCH_DISK_ROOM_B", room_B, 1);
    setenv("TWINBENCH_DISK_TELLS", tells ? "1" : "0", 1);
    setenv("LD_PRELOAD", POWER_CUT_DISK, 1);
    const Outcome outcome = Call(Measure(name));
    for (const char* set : {"LD_PRELOAD", "TWINBENCH_DISK_ROOT", "TWINBENCH_DISK_ROOM_B", "TWINBENCH_DISK_TELLS"})
      unsetenv(set);
    return outcome;
  }

  void ExpectPausesAndGoesOn(const char* room_B, bool tells, const std::string& said) {
    const Outcome full = MeasureWithRoom("full", room_B, tells);
    EXPECT_EQ(full.exit_code, 1);
    EXPECT_THAT(full.err, testing::HasSubstr("tables were brought to rest"));
    EXPECT_THAT(full.err, testing::HasSubstr(said));
    const std::size_t kept = RunRecord::Open(At("full"))->Readings().size();
    EXPECT_GT(kept, 10u);
    EXPECT_LT(kept, 628u);
    Succeed(Measure("full"));
    EXPECT_EQ(ReadingsOf("full"), ReadingsOf("undisturbed"));
  }
};

TEST_F(FullDisk, PausesTheRunBeforeAReadingIsLost) {
  ExpectPausesAndGoesOn("7000000", true, "the run pauses before a reading is lost");
}

TEST_F(FullDisk, ThatDoesNotTellCostsNoReadingEither) {
  ExpectPausesAndGoesOn("3000000", false, "full");
}

}  // namespace
}  // namespace twinbench::test
