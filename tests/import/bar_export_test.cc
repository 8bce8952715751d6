#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/import/importing.h"

// What software of ball bars exports: tags, then the values of each run, one a line.
namespace twinbench::imports {
namespace {

using testing::HasSubstr, testing::Not;

constexpr double kRadian_deg = 180.0 / std::numbers::pi;

double Bar_um(double angle_deg) {
  return 4.0 * std::sin(2.0 * angle_deg / kRadian_deg) + 0.01 * angle_deg;
}

/// @param from_deg, to_deg  Of the values, both of them there.
std::string BarValues(double from_deg, double to_deg, int count, const char* form = "{:.4f}\n",
                      double factor = 1.0) {
  std::string text;
  for (int k = 0; k < count; ++k) {
    const double at_deg = from_deg + (to_deg - from_deg) * k / (count - 1);
    text += fmt::format(fmt::runtime(form), factor * Bar_um(std::remainder(at_deg - 180.0, 360.0) + 180.0));
  }
  return text;
}

class BarExport : public Importing {
 protected:
  static void Expect(const Imported& taken, double radius_mm, double feed_mm_min, std::size_t readings) {
    const Quantity x_m{"commanded_x_mm"}, y_m{"commanded_y_mm"}, feed_m_s{"feed_mm_min"}, bar_m{"bar_um"};
    EXPECT_EQ(taken.bench, "circular_motion");
    ASSERT_EQ(taken.readings.size(), readings) << taken.story;
    for (const Reading& r : taken.readings) {
      const double angle_deg = std::atan2(y_m(r), x_m(r)) * kRadian_deg;
      EXPECT_NEAR(std::hypot(x_m(r), y_m(r)) / units::mm, radius_mm, 1e-6);
      EXPECT_NEAR(feed_m_s(r) * 60.0 / units::mm, feed_mm_min, 1e-6);
      const double away_um = bar_m(r) / units::um - Bar_um(angle_deg < -1e-9 ? angle_deg + 360.0 : angle_deg);
      ASSERT_LT(std::abs(std::remainder(away_um, 3.6)), 2e-3) << angle_deg << taken.story;  // 3.6: a turn more
    }
  }
};

TEST_F(BarExport, IsReadRunByRun) {
  const Imported taken = Take(
      "BALLBAR RESULTS\nOperator: 7\nRadius: 100 mm\nFeedrate: 500 mm/min\nStart angle: 0\nEnd angle: 360\nUnits: "
      "microns\n\nRun 1 CCW\n" +
      BarValues(0.0, 360.0, 361) + "Run 2 CW\n" + BarValues(360.0, 0.0, 361));
  Expect(taken, 100.0, 500.0, 722);
  EXPECT_EQ(taken.readings.front().direction, 1);
  EXPECT_EQ(taken.readings.back().direction, -1);
  EXPECT_THAT(taken.story, HasSubstr("taken as --map ball_bar"));
  EXPECT_THAT(taken.story, Not(HasSubstr("no tag says the unit")));
}

TEST_F(BarExport, MayHaveElementsMillimetresAndCommas) {
  const Imported taken = Take(
      "<Test>\n<TestRadius>150,0</TestRadius>\n<FeedRate>2000</FeedRate>\n<Unit>mm</Unit>\n<Unknown>12</"
      "Unknown>\n<Direction>clockwise</Direction>\n<Data>\n" +
      [] {
        std::string text = BarValues(359.5, 0.0, 720, "<v>{:.7f}</v>\n", 1e-3);
        std::ranges::replace(text, '.', ',');
        return text;
      }() +
      "</Data>\n</Test>\n");
  Expect(taken, 150.0, 2000.0, 720);
  EXPECT_EQ(taken.readings.front().direction, -1);
}

/// 220 deg between 20 and 240 deg, of which 45 deg at either end are overshoot: 100 values a second at 6000 mm/min
/// on 100 mm.
TEST_F(BarExport, LeavesOvershootOutWhereTheSamplingSaysThatItIsThere) {
  const double step_deg = 1.0 / 100.0 * kRadian_deg;  // 1 mm a value
  const int count = static_cast<int>(std::lround(310.0 / step_deg)) + 1;
  const std::string tags =
      "radius = 100\nfeed rate = 6000\nstart angle = 20\nend angle = 240\novershoot = 45\ndirection = ccw\n";
  const Imported taken = Take(tags + "sample rate = 100\n" + BarValues(-25.0, 285.0, count));
  EXPECT_EQ(taken.readings.size(),
            static_cast<std::size_t>(count) - 2U * static_cast<std::size_t>(std::lround(45.0 / 310.0 * count)))
      << taken.story;
  const Quantity x_m{"commanded_x_mm"}, y_m{"commanded_y_mm"}, bar_m{"bar_um"};
  for (const Reading& r : taken.readings) {
    const double angle_deg = std::atan2(y_m(r), x_m(r)) * kRadian_deg;
    ASSERT_NEAR(bar_m(r) / units::um, Bar_um(angle_deg < 0.0 ? angle_deg + 360.0 : angle_deg), 0.05)
        << "half a step at 8 um/rad";
  }
  Expect(Take(tags + BarValues(20.0, 240.0, 221)), 100.0, 6000.0, 221);
}

TEST_F(BarExport, MayHaveAFeedForEachRun) {
  std::string text = "test radius: 100\nunits: um\n";
  for (const int feed : {500, 2000})
    for (const bool ccw : {true, false})
      text += fmt::format("feed: {}\n{}\n", feed, ccw ? "ccw" : "cw") +
              (ccw ? BarValues(0.0, 359.0, 360) : BarValues(359.0, 0.0, 360));
  const Imported taken = Take(text);
  ASSERT_EQ(taken.readings.size(), 4U * 360U) << taken.story;
  EXPECT_EQ(taken.readings.back().pass, 3);
  EXPECT_THAT(taken.set, testing::Contains("circular_procedure.feeds_mm_min=[500, 2000]"));
}

TEST_F(BarExport, LeavesTablesAlone) {
  std::string text = "Radius: 150\nFeed: 1000\nDirection: CCW\nangle [deg],deviation [um]\n";
  for (int k = 0; k < 72; ++k) text += fmt::format("{},{}\n", 5 * k, k % 7);
  const Imported taken = Take(text);
  ASSERT_EQ(taken.readings.size(), 72U) << taken.story;
  EXPECT_THAT(taken.story, Not(HasSubstr("tags and runs")));
}

}  // namespace
}  // namespace twinbench::imports
