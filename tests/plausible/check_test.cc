#include "twin/plausible/check.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/core/input_error.h"
#include "twin/core/units.h"

namespace twinbench::plausible {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A device beside its reference, half a turn forth and back.
std::vector<Reading> Readings(int count = 200) {
  std::vector<Reading> readings;
  for (int i = 0; i < count; ++i) {
    const bool back = i >= count / 2;
    Reading r;
    r.reading = i;
    r.time = Time(FromSeconds(i));
    r.pass = back ? 1 : 0;
    r.direction = back ? -1 : 1;
    r.position = back ? count - 1 - i : i;
    r.reference_rad = r.position * 1.8 * units::deg;
    r.measured_rad = r.reference_rad + 1e-4 * std::sin(17.0 * i);
    readings.push_back(r);
  }
  return readings;
}

Scenario Angles() {
  return ParseScenario("bench = \"encoder_comparison\"\n", "test", "");
}

std::string Lines(const std::vector<Reading>& readings, const Scenario& scenario = Angles()) {
  return InLines(Check(readings, scenario));
}

TEST(Plausible, SaysNothingOfGoodReadings) {
  EXPECT_THAT(Lines(Readings()), IsEmpty());
}

TEST(Plausible, NamesADeadChannel) {
  std::vector<Reading> readings = Readings();
  for (Reading& r : readings) r.measured_rad = 0.0;
  EXPECT_THAT(Lines(readings), HasSubstr("cannot be: measured_deg = 0 in all 200 readings"));
  EXPECT_THAT(MessageOf([&] { RefuseFatal(Check(readings, Angles()), "run"); }),
              HasSubstr("run: measured_deg = 0"));
}

TEST(Plausible, DoubtsAChannelThatWasStuckForAWhile) {
  std::vector<Reading> readings = Readings();
  for (int i = 60; i < 95; ++i) readings[i].measured_rad = readings[60].measured_rad;
  EXPECT_THAT(Lines(readings), HasSubstr("doubtful: measured_deg stands still"));
  EXPECT_THAT(Lines(readings), HasSubstr("for 35 readings, up to reading 94"));
}

TEST(Plausible, RefusesPositionsThatAreAllTheSame) {
  std::vector<Reading> readings = Readings();
  for (Reading& r : readings) r.position = 0;
  EXPECT_THAT(Lines(readings), HasSubstr("cannot be: 198 of 200 readings have the position of another one"));
}

TEST(Plausible, RefusesAnAngleThatNothingTurnsToInTheTime) {
  std::vector<Reading> readings = Readings();
  readings[150].reference_rad = 1e17 * units::deg;
  EXPECT_THAT(Lines(readings), HasSubstr("cannot be: reference_deg is 2.78e+14 turns from where it was 1 s before, in reading 150"));
  for (Reading& r : readings) r.reference_rad = r.reading * 1000.0 * units::turn;  // 60 000 turns a minute
  EXPECT_THAT(Lines(readings), testing::Not(HasSubstr("turns from where it was")));
}

TEST(Plausible, DoubtsDirectionsThatTheAnglesContradict) {
  std::vector<Reading> readings = Readings();
  for (Reading& r : readings) r.direction = -r.direction;
  EXPECT_THAT(Lines(readings), HasSubstr("go against the direction"));
}

TEST(Plausible, SaysWhenAResolutionIsCoarse) {
  std::vector<Reading> readings = Readings();
  for (Reading& r : readings) r.measured_rad = std::round(r.measured_rad / (9.0 * units::deg)) * 9.0 * units::deg;
  EXPECT_THAT(Lines(readings), HasSubstr("steps of 9"));
}

TEST(Plausible, RefusesTooFewReadings) {
  EXPECT_THAT(Lines({}), HasSubstr("cannot be: there are 0 readings"));
  EXPECT_THAT(Lines(Readings(2)), HasSubstr("there are only 2 readings"));
}

TEST(Plausible, SaysThatAClockStands) {
  std::vector<Reading> readings = Readings();
  for (Reading& r : readings) r.time = Time{};
  EXPECT_THAT(Lines(readings), HasSubstr("the same time"));
}

/// Four detector channels about a volt.
std::vector<Reading> Voltages() {
  std::vector<Reading> readings;
  for (int i = 0; i < 72; ++i) {
    Reading r;
    r.reading = r.position = i;
    r.time = Time(FromSeconds(i));
    r.target_rad = i * 5.0 * units::deg;
    r.reference_rad = -r.target_rad;
    for (int c = 0; c < kChannels; ++c) r.mean_V[c] = std::sin(3.0 * i + c);
    readings.push_back(r);
  }
  return readings;
}

TEST(Plausible, RefusesVoltsThatTheCardCannotGive) {
  const Scenario scenario = ParseScenario("bench = \"rotary_4dof\"\n", "test", "");
  EXPECT_THAT(Lines(Voltages(), scenario), IsEmpty());
  std::vector<Reading> one = Voltages(), in_mV = Voltages();
  one[7].mean_V[1] = 1e308;
  EXPECT_THAT(Lines(one, scenario),
              HasSubstr("cannot be: 1 values of psd_a_y_V are outside the converter's range of 10, reading 7"));
  for (Reading& r : in_mV) r.mean_V[0] *= 1000.0;
  EXPECT_THAT(Lines(in_mV, scenario), HasSubstr("is it in mV?"));
}

TEST(Plausible, PutsWhatCannotBeFirst) {
  std::vector<Reading> readings = Readings();
  for (Reading& r : readings) {
    r.direction = -r.direction;
    r.position = 0;
  }
  const std::vector<Finding> findings = Check(readings, Angles());
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_TRUE(findings[0].fatal);
  EXPECT_FALSE(findings[1].fatal);
}

}  // namespace
}  // namespace twinbench::plausible
