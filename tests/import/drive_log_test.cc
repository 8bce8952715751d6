#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/import/importing.h"
#include "twin/core/reading_column.h"

// Logs of controllers on circles, with all that goes before, between and behind them.
namespace twinbench::imports {
namespace {

using testing::Contains, testing::HasSubstr;

/// Rows of a tool that goes from angle to angle on 40 mm about (-160, 75) mm, all of them one after the other.
class DriveLog : public Importing {
 protected:
  void Arc(double from_rad, double to_rad, double feed_mm_min) {
    constexpr double kRadius_mm = 40.0, kStep_s = 0.004;
    const double rate = feed_mm_min / 60.0 / kRadius_mm, way = std::abs(to_rad - from_rad);
    for (double gone = 0.0; gone < way; gone += rate * kStep_s) {
      const double at = from_rad + std::copysign(gone, to_rad - from_rad);
      const double x = -160.0 + kRadius_mm * std::cos(at), y = 75.0 + kRadius_mm * std::sin(at);
      text_ += fmt::format("{:.4f}\t{:.6f}\t{:.6f}\t{:.6f}\t{:.6f}\n", time_s_ += kStep_s, x, y,
                           x + 0.001 * std::cos(2.0 * at), y);
    }
  }
  /// At a steadily changing feed.
  void Ramp(double at_rad, double from_mm_min, double to_mm_min, int sense) {
    double angle = at_rad;
    for (int k = 0; k < 30; ++k) {
      const double feed = from_mm_min + (to_mm_min - from_mm_min) * k / 30.0,
                   next = angle + sense * feed / 60.0 / 40.0 * 0.004;
      Arc(angle, next, feed);
      angle = next;
    }
  }
  std::string text_ = "Zeit [s]\tSoll Y [mm]\tSoll Z [mm]\tIst Y [mm]\tIst Z [mm]\n";
  double time_s_ = 0.0;
};

TEST_F(DriveLog, MayHaveSeveralFeedsOneAfterTheOther) {
  for (const double feed_mm_min : {1000.0, 4000.0}) {
    for (const int sense : {1, -1}) {
      Ramp(0.0, 10.0, feed_mm_min, sense);
      Arc(0.0, sense * units::turn, feed_mm_min);
    }
  }
  const Imported taken = Take(text_);
  EXPECT_THAT(taken.story, HasSubstr("taken as --map xy_log"));
  EXPECT_THAT(taken.set, Contains("circular_procedure.feeds_mm_min=[1000, 4000]"));
  EXPECT_THAT(taken.set, Contains(HasSubstr("instrument=\"drive\"")));
  const Quantity feed_m_s{"feed_mm_min"};
  std::set<std::pair<int, long>> passes;
  for (const Reading& r : taken.readings) passes.insert({r.direction, std::lround(feed_m_s(r) * 60.0 / units::mm)});
  EXPECT_EQ(passes, (std::set<std::pair<int, long>>{{-1, 1000}, {-1, 4000}, {1, 1000}, {1, 4000}}));
}

}  // namespace
}  // namespace twinbench::imports
