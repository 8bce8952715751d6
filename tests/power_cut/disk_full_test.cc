#include <gmock/gmock.h>

#include <cstdlib>

#include "tests/tools/program.h"
#include "twin/core/run_record.h"

namespace twinbench::test {
namespace {

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
