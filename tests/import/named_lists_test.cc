#include "tests/import/importing.h"
#include "tests/support/noise.h"
#include "twin/import/layouts.h"

/// Logs in which a program prints the lists of a robot's joints, each under its name.
namespace twinbench::imports {
namespace {

using testing::HasSubstr;

constexpr double kPlace_rad[] = {-0.9, 1.2, 0.35, -1.3}, kOff_rad = 0.012;

/// One pose again and again; the joints 2 and 3 stand a little off, each time elsewhere.
std::string OnePose(const char* mark) {
  test::Noise noise(0.002, 9);
  std::string text = "started by hand\n";
  for (int i = 0; i < 60; ++i) {
    text += fmt::format("Timestamp{}2024-05-06 10:{:02d}:07.5\n Order given{}\t[", mark, i, mark);
    for (int k = 0; k < 4; ++k) text += fmt::format("{}{}", k > 0 ? ", " : "", kPlace_rad[k]);
    text += fmt::format("]\n Actual position{}\t[", mark);
    for (int k = 0; k < 4; ++k) text += fmt::format("{}{:.5f}", k > 0 ? ", " : "", kPlace_rad[k] + (k >= 2 ? kOff_rad + noise() : 0.0));
    text += "]\n";
    if (i == 20) text += "picking failed\n";
  }
  return text;
}

TEST_F(Importing, ComparesEachJointWithItsOwnOrder) {
  for (const char* mark : {":", " = "}) {
    const Imported taken = Take(OnePose(mark));
    EXPECT_THAT(taken.story, Says("records of lists under names", "reference <- Order given.2 [rad]",
                                  "measured <- Actual position.2 [rad]", "60 s between rows"));
    ASSERT_EQ(taken.readings.size(), 60u);
    double mean_rad = 0.0;
    for (const Reading& r : taken.readings) mean_rad += (r.measured_rad - r.reference_rad) / 60.0;
    EXPECT_NEAR(mean_rad, kOff_rad, 4 * 0.002 / std::sqrt(60.0));
  }
}

TEST_F(Importing, TakesAnotherJointThatIsSaid) {
  const Imported taken = Take(OnePose(":"), "", {"reference_rad=Order given.3", "measured_rad=Actual position.3"});
  EXPECT_NEAR(taken.readings.front().reference_rad, kPlace_rad[3], 1e-9);
}

TEST(NamedLists, AreAskedForTwoNamesThatComeAgain) {
  EXPECT_FALSE(AreNamedLists({"a = [1, 2, 3]", "b = [4, 5, 6]"}));
  EXPECT_FALSE(AreNamedLists({"a: [1, 2]", "a: [1, 3]", "a: [2, 3]", "a: [1, 4]"}));
  EXPECT_TRUE(AreNamedLists({"a: [1 2]", "b: [1 3]", "a: [2 3]", "b: [1 4]", "a: [2 3]", "b: [1 4]"}));
}

/// A command that never moves is one, where whatever moves is called a device; a column goes by its name without its unit.
TEST_F(Importing, TakesOrdersAndWhatIsActual) {
  std::string text = "timestamp,order_rad,actual_rad\n";
  for (int i = 0; i < 60; ++i) text += fmt::format("2024-05-06 10:{:02d}:07.5,0.7,{:.4f}\n", i, 0.71 + 0.001 * (i % 5));
  EXPECT_THAT(Take(text).story, HasSubstr("reference_deg is taken from \"order_rad\", by its name"));
  EXPECT_EQ(Take(text, "", {"reference_rad=order", "measured_rad=actual"}).readings.size(), 60u);
}

TEST_F(Importing, TakesPairsOfOneAxisOfARobotThatIsCorrectedByItsSensor) {
  std::string text = "X_RIst,Y_RIst,Z_RIst,X_RSol,Y_RSol,Z_RSol,MotorAmps\n";
  for (int i = 0; i < 100; ++i) text += fmt::format("{:.1f},{:.1f},977.3,1279.5,{:.1f},977.3,{}\n", 1279.5 + 0.1 * (i % 2), 3.0 * i + 0.2, 3.0 * i, 40 + i % 5);
  const std::string story = Take(text).story;
  EXPECT_THAT(story, Says("reference <- Y_RSol", "measured <- Y_RIst"));
}

/// The order in which readings were taken is nobody's command.
TEST_F(Importing, LeavesTheOrderOfRowsAside) {
  std::string text = "order,angle,encoder\n";
  for (int i = 0; i < 72; ++i) text += fmt::format("{},{},{}\n", i + 1, 5 * i, 5 * i + 0.1 * (i % 3));
  EXPECT_THAT(Take(text).story, HasSubstr("reference <- angle"));
}

}  // namespace
}  // namespace twinbench::imports
