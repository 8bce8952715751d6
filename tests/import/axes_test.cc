#include "tests/import/importing.h"
#include "tests/support/noise.h"
#include "twin/import/layouts.h"

/// Logs of a controller with several axes, and what it told them.
namespace twinbench::imports {
namespace {

using testing::HasSubstr, testing::Not;

double Command_deg(int axis, double time_s) { return 20.0 * axis * std::sin(0.9 * time_s + axis); }

/// Each axis reads its own number of hundredths of a degree too much.
double Shown_deg(int axis, double time_s) { return Command_deg(axis, time_s) * (1.0 + 0.01 * axis); }

double ScaleOf(const Imported& imported) {
  double products = 0.0, squares = 0.0;
  for (const Reading& r : imported.readings) {
    products += r.measured_rad * r.reference_rad;
    squares += r.reference_rad * r.reference_rad;
  }
  return products / squares - 1.0;
}

/// Three joints side by side, with gains of the controller that change once.
std::string SideBySide() {
  std::string text = "time_s";
  for (int axis = 1; axis <= 3; ++axis) text += fmt::format(",MotorCmdKd_{0},MotorCmdQ_{0},MotorStateQ_{0}", axis);
  text += "\n";
  for (int i = 0; i < 900; ++i) {
    text += fmt::format("{:.3f}", 0.01 * i);
    for (int axis = 1; axis <= 3; ++axis)
      text += fmt::format(",{},{:.5f},{:.5f}", i < 450 ? 2 : 3, Command_deg(axis, 0.01 * i) * units::deg, Shown_deg(axis, 0.01 * i) * units::deg);
    text += "\n";
  }
  return text;
}

/// The same below each other.
std::string BelowEachOther() {
  std::string text = "time_s,joint,target_deg,position_deg\n";
  for (int i = 0; i < 900; ++i) {
    for (int axis = 1; axis <= 3; ++axis)
      text += fmt::format("{:.3f},{},{:.4f},{:.4f}\n", 0.01 * i, axis, Command_deg(axis, 0.01 * i), Shown_deg(axis, 0.01 * i));
  }
  return text;
}

TEST_F(Importing, TakesOneOfSeveralAxesAndSaysWhichThereAre) {
  for (const std::string& text : {SideBySide(), BelowEachOther()}) {
    for (int axis = 1; axis <= 3; ++axis) {
      const Imported imported = TakeReadings(900, text, fmt::format("[course]\naxis_number = {}\n", axis));
      EXPECT_NEAR(ScaleOf(imported), 0.01 * axis, 1e-4) << axis;
      EXPECT_THAT(imported.story, Says("3 axes are in the file", "--axis-number"));
    }
    EXPECT_NEAR(ScaleOf(Take(text)), 0.01, 1e-4) << "the first";
    EXPECT_THAT(MessageOf([&] { Take(text, "[course]\naxis_number = 4\n"); }), HasSubstr("1 to 3"));
  }
}

TEST_F(Importing, SaysNothingOfAxesWhereThereIsOne) {
  std::string text = "time_s,command_1,actual_1,temperature_2\n";
  for (int i = 0; i < 300; ++i) text += fmt::format("{:.3f},{:.4f},{:.4f},{}\n", 0.01 * i, Command_deg(1, 0.01 * i), Shown_deg(1, 0.01 * i), 20 + i % 2);
  EXPECT_THAT(Take(text).story, Not(HasSubstr("axes")));
  EXPECT_THAT(MessageOf([&] { Take(text, "[course]\naxis_number = 2\n"); }), HasSubstr("no several axes")) << "which would be ignored";
}

TEST_F(Importing, TakesOneOfSeveralAxesThatAreSentToOnePlaceEach) {
  std::string text = "time_s,command_1,actual_1,command_2,actual_2\n";
  for (int i = 0; i < 60; ++i) text += fmt::format("{},10.0,{:.4f},-25.0,{:.4f}\n", i, 10.0 + 0.01 * (i % 7), -25.3 + 0.02 * (i % 5));
  const Imported second = Take(text, "[course]\naxis_number = 2\n");
  EXPECT_THAT(second.story, HasSubstr("\"actual_2\" against \"command_2\""));
  EXPECT_NEAR(second.readings.front().measured_rad / units::deg, -25.3, 1e-9);
}

/// Ways of 40 deg with rests between, every 5 ms, to places that differ.
std::string Profiles(const char* reference) {
  std::string text = fmt::format("time_s,{}_deg,position_deg\n", reference);
  double from_deg = 0.0, time_s = 0.0;
  for (int way = 0; way < 12; ++way) {
    const double by_deg = way % 3 == 2 ? -55.0 : 30.0 + way;
    for (int i = 0; i < 220; ++i, time_s += 0.005) {
      const double share = std::clamp((i - 120) / 100.0, 0.0, 1.0), at_deg = from_deg + by_deg * share * share * (3.0 - 2.0 * share);
      text += fmt::format("{:.4f},{:.4f},{:.4f}\n", time_s, at_deg, at_deg - 0.01);
    }
    from_deg += by_deg;
  }
  return text;
}

TEST_F(Importing, TakesACommandThatMovesAlongProfilesAsMotion) {
  const Imported driven = TakeReadings(12 * 220, Profiles("target"));
  EXPECT_THAT(driven.story, HasSubstr("moves along profiles"));
  EXPECT_LT(Take(Profiles("target"), "[course]\nkind = \"stops\"\n").readings.size(), 100u);
  EXPECT_LT(Take(Profiles("interferometer")).readings.size(), 30u) << "stops against a reference of its own";
}

TEST_F(Importing, KeepsToTheNumberOfReadingsThatIsStated) {
  const Imported means = Take(Profiles("target"), "[average]\nmost_readings = 400\n");
  EXPECT_LE(means.readings.size(), 400u);
  EXPECT_GE(means.readings.size(), 150u);
}

// Logs in which a program prints the lists of a robot's joints, each under its name.

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
