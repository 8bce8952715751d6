#include "tests/import/importing.h"

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
      const Imported imported = Take(text, fmt::format("[course]\naxis_number = {}\n", axis));
      EXPECT_EQ(imported.readings.size(), 900u);
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
  const Imported driven = Take(Profiles("target"));
  EXPECT_EQ(driven.readings.size(), 12u * 220u);
  EXPECT_THAT(driven.story, HasSubstr("moves along profiles"));
  EXPECT_LT(Take(Profiles("target"), "[course]\nkind = \"stops\"\n").readings.size(), 100u);
  EXPECT_LT(Take(Profiles("interferometer")).readings.size(), 30u) << "stops against a reference of its own";
}

TEST_F(Importing, KeepsToTheNumberOfReadingsThatIsStated) {
  const Imported means = Take(Profiles("target"), "[average]\nmost_readings = 400\n");
  EXPECT_LE(means.readings.size(), 400u);
  EXPECT_GE(means.readings.size(), 150u);
}

}  // namespace
}  // namespace twinbench::imports
