#include "tests/core/input_error.h"
#include "tests/support/kept_text.h"
#include "twin/core/units.h"
#include "twin/import/blocks.h"
#include "twin/import/clock.h"
#include "twin/import/expression.h"
#include "twin/import/follows.h"
#include "twin/import/layouts.h"

namespace twinbench::imports {
namespace {

using testing::ElementsAre;

TEST(UnitNames, AreTakenOffHeadersHoweverTheyAreWritten) {
  for (const char* header : {"Angle [deg]", "Angle (deg)", "Angle / deg", "Angle [°]", "Angle (degrees)"}) {
    const NameAndUnit split = SplitHeader(header);
    EXPECT_EQ(split.name, "Angle") << header;
    ASSERT_TRUE(UnitNamed(split.unit)) << header;
    EXPECT_EQ(UnitNamed(split.unit)->name, "deg") << header;
  }
  EXPECT_EQ(SplitHeader("angle_mrad").unit, "mrad");
  EXPECT_EQ(SplitHeader("angle_mrad").name, "angle_mrad") << "such a name is kept whole";
  EXPECT_EQ(SplitHeader("speed (fast)").unit, "");
  EXPECT_EQ(SplitHeader("count").unit, "");
  EXPECT_FALSE(UnitNamed("furlong"));
}

/// By what they are defined as, in full: nothing here is the program's.
TEST(UnitNames, AreTheirDefinitionsInSI) {
  const std::map<std::string, double> in_SI = {
      {"deg", 0.017453292519943295}, {"mrad", 1e-3}, {"urad", 1e-6}, {"arcsec", 4.8481368110953599e-6},
      {"arcmin", 2.908882086657216e-4}, {"mdeg", 1.7453292519943295e-5}, {"gon", 0.015707963267948967},
      {"turn", 6.2831853071795865}, {"mm", 1e-3}, {"um", 1e-6}, {"nm", 1e-9}, {"inch", 0.0254}, {"ms", 1e-3},
      {"us", 1e-6}, {"ns", 1e-9}, {"min", 60.0}, {"h", 3600.0}, {"mV", 1e-3}, {"rad", 1.0}};
  for (const auto& [name, SI] : in_SI) EXPECT_NEAR(UnitNamed(name)->to_SI / SI, 1.0, 1e-15) << name;
}

TEST(Clock, ReadsInstantsInTheOrdersThatAreUsual) {
  const double moment_s = 1635325488.5;  // 2021-10-27 09:04:48.5
  for (const char* text : {"2021-10-27 09:04:48.5", "2021-10-27T09:04:48.500Z", "27.10.2021 09:04:48,5",
                           "2021/10/27 9:04:48.5", "10/27/2021 9:04:48.5 AM", "2021-10-27T11:04:48.5+02:00"}) {
    const auto instant = ParseInstant(text);
    ASSERT_TRUE(instant) << text;
    EXPECT_TRUE(instant->has_date);
    EXPECT_NEAR(instant->time_s, moment_s, 1e-6) << text;
  }
  EXPECT_NEAR(ParseInstant("09:04:48.25")->time_s, 32688.25, 1e-9);
  EXPECT_FALSE(ParseInstant("09:04:48.25")->has_date);
  for (const char* text : {"12.5", "2021-13-27 09:04:48", "hello", "", "25:00:00", "1.2.3"})
    EXPECT_FALSE(ParseInstant(text)) << text;
}

TEST(Clock, KnowsWhatNumbersCountByTheirSize) {
  const double moment_s = 1651506984.376;
  for (const double number : {moment_s, moment_s * 1e3, moment_s * 1e6, 132959805843760000.0}) {
    const auto clock = ClockOf({number}, "");
    ASSERT_TRUE(clock);
    EXPECT_TRUE(clock->absolute);
    EXPECT_NEAR((number - clock->origin) * clock->to_s, moment_s, 1e-3) << number;
  }
  EXPECT_FALSE(ClockOf({12.5}, "")->absolute);
  EXPECT_EQ(ClockOf({12.5}, "ms")->to_s, 1e-3);
  EXPECT_FALSE(ClockOf({12.5}, "furlong"));
}

TEST(Text, KeepsSeparatorsInsideQuotesAndTakesBlanksTogether) {
  std::vector<std::string_view> fields;
  Split("1, \"a, b\" ,3", ',', fields);
  EXPECT_THAT(fields, ElementsAre("1", "a, b", "3"));
  Split("  1.5   2\t3 ", ' ', fields);
  EXPECT_THAT(fields, ElementsAre("1.5", "2", "3"));
  Split("| 1 | 2 |", '|', fields);
  EXPECT_THAT(fields, ElementsAre("1", "2"));
  EXPECT_EQ(FieldNumber("1,25", true), 1.25);
  EXPECT_FALSE(FieldNumber("1,25", false));
  EXPECT_EQ(FieldNumber("1.250,5", true), 1250.5);
  EXPECT_EQ(FieldNumber("-1,234,567.25", false), -1234567.25);
  EXPECT_EQ(FieldNumber("1 234,5", true), 1234.5);
  EXPECT_EQ(FieldNumber("\xE2\x88\x92" "4.5", false), -4.5);
  for (const char* text : {"1.250", "1.25,5", "12.3456,5", ".250,5"}) EXPECT_FALSE(FieldNumber(text, true)) << text << " may be either, or is none";
  EXPECT_FALSE(FieldNumber("nan", false));
}

TEST(Text, ReadsNumbersWithAUnitInTheirCell) {
  const std::map<std::string, std::pair<double, std::string>> cells = {
      {"12.5 deg", {12.5, "deg"}}, {"-3mm", {-3.0, "mm"}}, {"12.5°", {12.5, "°"}}, {"7", {7.0, ""}}, {"12° 30' 36\"", {12.51, "deg"}},
      {"-0° 30' 00.0\"", {-0.5, "deg"}}, {"350°15′", {350.25, "deg"}}};
  for (const auto& [text, cell] : cells) {
    const auto read = CellOf(text, false);
    ASSERT_TRUE(read) << text;
    EXPECT_NEAR(read->number, cell.first, 1e-12) << text;
    EXPECT_EQ(read->unit, cell.second) << text;
  }
  for (const char* text : {"3 up", "run 4 deg", "12° 70'", "deg", ""}) EXPECT_FALSE(CellOf(text, false)) << text;
}

std::vector<double> Evaluate(const std::string& text, const std::vector<double>& x) {
  static const std::vector<std::string> words = {"W", "E"};
  return Expression(text, "test").Evaluate(x.size(), [&x](const std::string& name) -> Values {
    if (name == "side") return {{0.0, 1.0, kNaN}, &words};
    EXPECT_THAT(name, testing::AnyOf("x", "a long name [V]", "Pixel scale"));
    return {name == "Pixel scale" ? std::vector{2.0} : x, nullptr};
  });
}

TEST(Array, NeedsABracketOnEitherSide) {
  for (const char* text : {"const] = { 1, 2 }", "= { 1, 2 }", "] = { 1, 2 }"}) {
    Recording recording;
    EXPECT_THROW(ReadArray(text, "", recording), InputError) << text;
  }
  Recording recording;
  ReadArray("const int table[2] = { 1, 2 };", "", recording);
  EXPECT_EQ(recording.tracks.at(0).name, "table");
}

TEST(Expression, TakesColumnsThroughArithmetic) {
  const std::vector<double> x = {1.0, 2.0, 4.0};
  EXPECT_THAT(Evaluate("x * 2 + 1", x), ElementsAre(3.0, 5.0, 9.0));
  EXPECT_THAT(Evaluate("-x ^ 2", x), ElementsAre(-1.0, -4.0, -16.0));
  EXPECT_THAT(Evaluate("(x - 1) / [Pixel scale]", x), ElementsAre(0.0, 0.5, 1.5));
  EXPECT_THAT(Evaluate("before(x)", x), ElementsAre(0.0, 1.0, 3.0));
  EXPECT_THAT(Evaluate("is(side, W) - is(side, E)", x), ElementsAre(1.0, -1.0, 0.0));
  EXPECT_NEAR(Evaluate("atan2(sin(x), cos(x))", x)[0], 1.0, 1e-15);
  EXPECT_THAT(Evaluate("7", x), ElementsAre(7.0, 7.0, 7.0));
}

TEST(Expression, FindsTheUnitInWhichATableGoesRoundOnce) {
  for (const double turn : {360.0, 36000.0, 2.0 * units::kPi, 16384.0, 65536.0}) {
    std::vector<double> x;
    for (int i = 0; i < 1000; ++i) x.push_back(std::fmod(0.3 + 0.001 * i, 1.0) * turn);
    EXPECT_NEAR(Evaluate("turns(x)", x)[0], 0.3, 1e-12) << turn;
  }
  EXPECT_KEPT(MessageOf([] { Evaluate("turns(x)", {0.0, 1.0, 5.0, 123.0}); }));
}

TEST(Expression, SaysWhereItCannotBeRead) {
  for (const char* text : {"x +", "(x", "x ** 2", "atan2(x)", "[x", "3 x"})
    EXPECT_KEPT(MessageOf([text] { Evaluate(text, {1.0}); }));
  EXPECT_KEPT(MessageOf([] { Evaluate("side * 2", {1.0, 2.0, 3.0}); }));
}

std::vector<double> Clocked(std::size_t rows) {
  std::vector<double> time_s;
  for (std::size_t i = 0; i < rows; ++i) time_s.push_back(0.1 * static_cast<double>(i));
  return time_s;
}

/// Up, rest, down: a degree a row.
std::vector<double> UpAndDown() {
  std::vector<double> x;
  for (int i = 0; i < 100; ++i) x.push_back(i * units::deg);
  for (int i = 0; i < 20; ++i) x.push_back(99.0 * units::deg);
  for (int i = 0; i < 100; ++i) x.push_back((98.0 - i) * units::deg);
  return x;
}

TEST(Course, FindsReversalsAndRests) {
  const std::vector<double> x = UpAndDown();
  const Course course = CourseOf(x, Clocked(x.size()), {}, 0.0);
  EXPECT_FALSE(course.stops);
  EXPECT_EQ(std::pair(course.reversals, course.rests), std::pair(1, 1));
  const std::tuple<std::size_t, int, Motion> rows[] = {
      {50, 1, Motion::kSteady}, {110, 0, Motion::kRest}, {200, -1, Motion::kSteady}};
  for (const auto& [row, direction, motion] : rows) {
    EXPECT_EQ(course.direction[row], direction) << row;
    EXPECT_EQ(course.motion[row], motion) << row;
  }
  EXPECT_NEAR(course.velocity[50], 10.0 * units::deg, 1e-9);
  EXPECT_EQ(course.pass[50] + 1, course.pass[200]);
}

TEST(Course, OfACommandThatJumpsIsStopsHoweverFewPlacesItKnows) {
  std::vector<double> x;
  for (const double to_deg : {0.0, 10.0, 0.0, 10.0, 0.0, 10.0, 0.0, 10.0})
    x.insert(x.end(), 40, to_deg * units::deg);
  const Course course = CourseOf(x, Clocked(x.size()), {}, 0.0);
  ASSERT_TRUE(course.stop_and_go);
  const Blocks cut = CutIntoBlocks(course, Clocked(x.size()), {5000}, RestsOf(course, {}, 0.0));
  EXPECT_EQ(cut.blocks.size(), 24U) << "eight rests of three pieces";
  for (const Block& block : cut.blocks) {
    EXPECT_EQ(x[block.begin], x[block.end - 1]);
    EXPECT_GT(block.begin % 40, 10U) << "the servo is still on its way";
  }
}

TEST(Course, IsNotTurnedByNoise) {
  std::vector<double> x = UpAndDown();
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] += (i % 3 == 0 ? 1.0 : i % 3 == 1 ? -1.0 : 0.2) * 0.05 * units::deg;
  const Course course = CourseOf(x, Clocked(x.size()), {}, 0.0);
  EXPECT_EQ(course.reversals, 1);
  EXPECT_EQ(course.rests, 1);
}

TEST(Course, UnwrapsAReferenceThatStartsAgain) {
  std::vector<double> x;
  for (int i = 0; i < 300; ++i) x.push_back(std::fmod(7.0 * i, 360.0) * units::deg);
  EXPECT_NEAR(FindWrap(x, {}, false), units::turn, 1e-12);
  const Course course = CourseOf(x, Clocked(x.size()), {}, units::turn);
  EXPECT_EQ(course.wraps, 5);
  EXPECT_NEAR(course.reference.back(), 7.0 * 299 * units::deg, 1e-9);
  EXPECT_EQ(course.reversals, 0);
  EXPECT_EQ(FindWrap(UpAndDown(), {}, false), 0.0) << "nothing jumps";
  EXPECT_EQ(FindWrap(x, {}, true), 0.0) << "a length does not start again by itself";
}

TEST(Course, OfRowsWithoutAClockIsStopsInBothDirections) {
  std::vector<double> x;
  for (int run = 0; run < 2; ++run) {
    for (int i = 0; i < 10; ++i) x.push_back(0.1 * i);
    for (int i = 9; i >= 0; --i) x.push_back(0.1 * i);
  }
  const Course course = CourseOf(x, {}, {}, 0.0);
  EXPECT_TRUE(course.stops);
  EXPECT_EQ(course.reversals, 3);
  EXPECT_EQ(course.pass[5], 0);
  EXPECT_EQ(course.pass[10], 1) << "the last stop is visited again on the way back";
  EXPECT_EQ(course.direction[10], -1);
  EXPECT_EQ(course.pass[39], 3);
}

TEST(Course, CountsAFlyBackAsAPassOfTheSameDirection) {
  std::vector<double> x;
  for (int run = 0; run < 3; ++run) {
    for (int i = 0; i < 12; ++i) x.push_back(0.1 * i);
  }
  const Course course = CourseOf(x, {}, {}, 0.0);
  EXPECT_EQ(course.fly_backs, 2);
  EXPECT_EQ(course.reversals, 0);
  EXPECT_EQ(course.pass[12], 1);
  EXPECT_EQ(course.direction[12], 1);
}

/// A servo that takes most of each stop to go where it was told.
TEST(Following, OfACommandThatWaitsIsToldByItsArrivals) {
  std::vector<double> command, servo;
  double at = 0.0;
  for (const double to : {0.0, 0.1, 0.2, 0.1, 0.0, -0.1, 0.0, 0.1, 0.2}) {
    for (int i = 0; i < 10; ++i) {
      command.push_back(to);
      at += (to - at) * 0.3;
      servo.push_back(at);
    }
  }
  EXPECT_NEAR(FollowingOf(command, servo).gain, 1.0, 0.1);
}

TEST(Following, TellsUnitsAndSensesThatDoNotFit) {
  std::vector<double> x, by_57, against, around;
  for (int i = 0; i < 500; ++i) {
    x.push_back(0.02 * i);
    by_57.push_back(x.back() * 180.0 / units::kPi);
    against.push_back(-x.back());
    around.push_back(std::fmod(x.back(), units::turn));
  }
  EXPECT_NEAR(FollowingOf(x, around).gain, 1.0, 1e-9) << "a device that starts again follows all the same";
  for (const double gain : {FollowingOf(x, by_57).gain, FollowingOf(x, against).gain, 1000.0, 1.0 / 3600.0})
    EXPECT_KEPT(MeaningOfGain(gain));
  EXPECT_EQ(MeaningOfGain(7.3), "");
}

}  // namespace
}  // namespace twinbench::imports
