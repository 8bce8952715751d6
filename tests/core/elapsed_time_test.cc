#include "twin/core/elapsed_time.h"

#include "tests/support/kept_text.h"

namespace twinbench {
namespace {

const ClockMark kBegin{"a-b-c", 1000.0, 1.7e9};

TEST(ElapsedTime, GoesByTheTimeSinceTheMachineWasStartedHoweverTheDaysClockIsSet) {
  const Elapsed quiet = Between(kBegin, {"a-b-c", 1060.25, 1.7e9 + 60.3});
  EXPECT_EQ(quiet.time, FromSeconds(60.25));
  EXPECT_EQ(quiet.note, "");
  for (const double set_s : {86400.0, -86400.0, 2.0}) {
    const Elapsed jumped = Between(kBegin, {"a-b-c", 1060.25, 1.7e9 + 60.25 + set_s});
    EXPECT_EQ(jumped.time, FromSeconds(60.25));
    EXPECT_KEPT(jumped.note);
  }
}

TEST(ElapsedTime, GoesByUtcBehindARestartAndSaysSo) {
  const Elapsed restarted = Between(kBegin, {"d-e-f", 12.0, 1.7e9 + 600.5});
  EXPECT_EQ(restarted.time, FromSeconds(600.5));
  EXPECT_KEPT(restarted.note);
}

TEST(ElapsedTime, KeepsAMarkAsText) {
  const ClockMark now = ClockMarkNow();
  EXPECT_GT(now.since_boot_s, 0.0);
  const auto back = ParseClockMark(TextOf(now));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->boot, now.boot);
  EXPECT_NEAR(back->since_boot_s, now.since_boot_s, 1e-8);
  EXPECT_NEAR(back->utc_s, now.utc_s, 1e-6);
  EXPECT_EQ(ParseClockMark("iio:192.168.1.7"), std::nullopt);
  const auto without = ParseClockMark(TextOf({"", 3.0, 4.0}));
  ASSERT_TRUE(without);
  EXPECT_EQ(without->boot, "");
}

}  // namespace
}  // namespace twinbench
