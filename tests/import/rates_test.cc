#include "tests/import/importing.h"
#include "twin/import/column_words.h"

/// Speeds are no angles, whatever their units are called.
namespace twinbench::imports {
namespace {

using testing::AllOf, testing::HasSubstr, testing::Not;

/// A table that swings at up to 180 deg/s, and a gyro on it that shows 0.9 of it and counts the other way round.
std::string Swings(const std::string& names, double table_unit, double gyro_unit) {
  std::string text = names + "\n";
  for (int i = 0; i < 600; ++i) {
    const double rate_deg_s = 180.0 * std::sin(0.02 * i);
    text += fmt::format("{:.2f},{:.5f},{:.5f}\n", 50.0 + 0.01 * i, -0.9 * rate_deg_s / gyro_unit, rate_deg_s / table_unit);
  }
  return text;
}

constexpr double kRpm_deg_s = 6.0, kRad_deg = 180.0 / units::kPi;

TEST(Rates, HaveTheUnitsThatPeopleWrite) {
  for (const char* unit : {"RPM", "rpm", "r/min", "1/min", "rev/min", "rads/s", "rad/s", "deg/s", "°/s", "dps", "degs/sec"}) {
    const auto named = UnitNamed(unit);
    ASSERT_TRUE(named) << unit;
    EXPECT_EQ(named->dimension, Dimension::kTurning) << unit;
  }
  EXPECT_NEAR(UnitNamed("RPM")->to_SI, units::turn / 60.0, 1e-12);
  EXPECT_NEAR(UnitNamed("dps")->to_SI, units::deg, 1e-12);
  EXPECT_EQ(SplitHeader("Gyro Output (rads/s)").unit, "rads/s");
  EXPECT_EQ(SplitHeader("Hub angle (Theta in rad)").unit, "rad");
  EXPECT_EQ(SplitHeader("Motor torque (mNm)").unit, "mNm");
  EXPECT_EQ(SplitHeader("pos (2)").name, "pos (2)");
}

TEST(Rates, AreKnownByTheirNamesWhereNoUnitIsSaid) {
  const auto is_rate = [](const char* name) { return IsRate({name, "", {}, {}}); };
  for (const char* name : {"Input Rate", "gyro_z", "Motor Speed", "omega", "Drehzahl"}) EXPECT_TRUE(is_rate(name)) << name;
  for (const char* name : {"gyro angle", "encoder", "high speed shaft", "low speed"}) EXPECT_FALSE(is_rate(name)) << name;
}

TEST_F(Importing, TakesNoRatesForAnglesAndNoTrainForThem) {
  for (const auto& [names, table, gyro] : {std::tuple{"% Time (s),Gyro Output (rads/s),Input Rate (RPM)", kRpm_deg_s, kRad_deg},
                                           std::tuple{"time [s],gyro output [dps],motor input [r/min]", kRpm_deg_s, 1.0},
                                           std::tuple{"time [s],output rate,input rate", 1.0, 1.0}}) {
    const std::string refusal = MessageOf([&] { Take(Swings(names, table, gyro)); });
    EXPECT_THAT(refusal, AllOf(HasSubstr("are rates"), HasSubstr("what a rate adds up to"), HasSubstr("--column 'reference_rad=["))) << names;
    EXPECT_THAT(refusal, Not(HasSubstr("is not said"))) << names;
  }
}

TEST_F(Importing, ComparesRatesByTheFormulasThatTheRefusalHas) {
  const std::string text = Swings("% Time (s),Gyro Output (rads/s),Input Rate (RPM)", kRpm_deg_s, kRad_deg);
  EXPECT_THAT(MessageOf([&] { Take(text); }), HasSubstr("'measured_rad=[Input Rate] * 0.10472'"));
  for (const char* rate : {"reference_rad=[Input Rate] * 0.1047198", "reference_rad=[Input Rate (RPM)] * 0.1047198"}) {
    const Imported taken = Take(text, "", {rate, "measured_rad=[Gyro Output] * 1"});
    EXPECT_NEAR(std::abs(taken.readings.at(70).measured_rad / taken.readings.at(70).reference_rad), 0.9, 1e-4);
  }
  EXPECT_THAT(MessageOf([&] { Take(text, "", {"reference_rad=Input Rate", "measured_rad=Gyro Output"}); }), HasSubstr("Input Rate is in RPM, a rate"));
}

TEST_F(Importing, RefusesARateOfAUnitThatIsNotKnown) {
  std::string text = "reference [deg],measured (furlongs/s)\n";
  for (int i = 0; i < 72; ++i) text += fmt::format("{},{}\n", 5 * i, 5 * i);
  EXPECT_THAT(MessageOf([&] { Take(text); }), Not(HasSubstr("is not said")));
}

TEST_F(Importing, AsksWhetherAClockOfWholeSecondsCountsMilliseconds) {
  std::string text = "Time (s),commanded [deg],measured [deg]\n";
  for (int i = 0; i < 3000; ++i) text += fmt::format("{},{:.4f},{:.4f}\n", 5000 + i, 30.0 * std::sin(0.01 * i), 30.0 * std::sin(0.01 * (i - 100)));
  EXPECT_THAT(Take(text, "[course]\nkind = \"sweep\"\n").story, HasSubstr("if the clock counts ms: --column 'time_ms=its column'"));
}

}  // namespace
}  // namespace twinbench::imports
