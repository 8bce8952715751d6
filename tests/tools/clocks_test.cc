#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/input_error.h"
#include "tools/twinbench/measured_run.h"

/// How long ago a run began, told by a record and by what a computer's clocks show when it is taken up again.
namespace twinbench::test {
namespace {

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
