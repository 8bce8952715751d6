#include "tests/import/importing.h"
#include "tests/support/kept_text.h"
#include "twin/core/reading_clock.h"
#include "twin/import/column_words.h"

/// Which column is the clock, and which are speeds.
namespace twinbench::imports {
namespace {

using testing::AllOf, testing::HasSubstr, testing::Not;

/// A sine of 5 mm in 2 s, the device 4 ms late; a row every 10 ms.
std::string Rows(const char* format) {
  std::string text;
  for (int i = 0; i < 600; ++i) {
    const double command = -5.0 * std::cos(0.01 * i * units::kPi), device = -5.0 * std::cos((0.01 * i - 0.004) * units::kPi);
    text += fmt::format(fmt::runtime(format), 10 * i, command, device);
  }
  return text;
}

void ExpectMotionInTime(const Imported& imported, const char* what) {
  ASSERT_EQ(imported.readings.size(), 600u) << what;
  EXPECT_NEAR(ToSeconds(imported.readings[599].time - imported.readings[0].time), 5.99, 1e-6) << what;
  // Half way up it moves at 5 pi mm/s; a step of the command, 0.01 mm, between two rows on is 0.5 mm/s.
  EXPECT_NEAR(imported.readings[50].velocity_rad_s / units::deg, 5.0 * units::kPi, 0.5) << what;
  EXPECT_THAT(imported.story, HasSubstr("motion that is read while it goes on")) << what;
}

const std::vector<std::string> kTwo = {"reference_mm=[column 2]", "measured_mm=[column 3]"};

TEST_F(Importing, FindsAClockWithoutANameAndSaysIt) {
  const Imported imported = Take(Rows("{}\t{:.2f}\t{:.3f}\n"), "", kTwo);
  ExpectMotionInTime(imported, "named by the user");
  EXPECT_THAT(imported.story, HasSubstr("\"column 1\" rises in steps of 10: it is taken as a clock in ms"));
  ExpectMotionInTime(Take(Rows("{}\t{:.2f}\t{:.3f}\n")), "by their order");
}

/// A computer logs every 10 ms or so; the angle beside it that rises too is none.
TEST_F(Importing, FindsAClockWithoutANameThatAComputerKept) {
  std::string text, angles;
  double time_s = 2.0;
  for (int i = 0; i < 300; ++i) {
    text += fmt::format("{:.4f}, {:.3f}, {:.3f}\n", time_s, 30.0 - 30.0 * std::cos(0.02 * i), 30.0 - 30.0 * std::cos(0.02 * i - 0.05));
    angles += fmt::format("{:.4f}, {:.3f}, {:.3f}\n", 100.0 * time_s, 100.0 * time_s + 0.1, 100.0 * time_s + 0.1 * (i % 2));
    time_s += 0.01 + 0.001 * (i * i % 5);
  }
  EXPECT_THAT(Take(text).story, HasSubstr("it is taken as a clock in s"));
  EXPECT_THAT(Take(angles).story, Not(HasSubstr("taken as a clock"))) << "three angles";
}

TEST_F(Importing, TakesARateThatTheFileStates) {
  std::string text = "# sample rate: 100 Hz\n# baud rate: 115200\ncommanded [deg],measured [deg]\n";
  for (int i = 0; i < 300; ++i) text += fmt::format("{:.3f},{:.3f}\n", 30.0 * std::sin(0.05 * i), 30.0 * std::sin(0.05 * i - 0.02));
  EXPECT_NEAR(ToSeconds(Take(text).readings.back().time), 2.99, 1e-9);
  EXPECT_THAT(Take(text).story, HasSubstr("rows at 100 Hz, as \"sample rate\" says"));
}

TEST_F(Importing, TakesTheClockThatTheCommandLineNames) {
  std::vector<std::string> columns = kTwo;
  columns.emplace_back("time_ms=[column 1]");
  ExpectMotionInTime(Take(Rows("{}\t{:.2f}\t{:.3f}\n"), "", columns), "time_ms");
  columns = {"reference_mm=b", "measured_mm=c", "time_ms=a"};
  ExpectMotionInTime(Take("a,b,c\n" + Rows("{},{:.2f},{:.3f}\n"), "", columns), "a name of their own");
  columns.back() = "time_ms=d";
  EXPECT_KEPT(MessageOf([&] { Take("a,b,c\n" + Rows("{},{:.2f},{:.3f}\n"), "", columns); }));
}

TEST_F(Importing, TakesAColumnThatCountsTheRowsForNoClock) {
  std::string text;
  for (int i = 0; i < 72; ++i) text += fmt::format("{} {} {}\n", i, 5 * i, 5 * i + 0.01);
  const Imported imported = Take(text);
  EXPECT_THAT(imported.story, HasSubstr("it counts the rows"));
  EXPECT_NEAR(imported.readings.back().reference_rad / units::deg, 355.0, 1e-9);
}

TEST_F(Importing, TakesAReferenceInEqualStepsForNoClock) {
  std::string text;
  for (int i = 0; i < 72; ++i) text += fmt::format("{} {} {}\n", 5 * i, 5 * i + 0.01 * (i % 3), 20 + i % 7);
  EXPECT_THAT(Take(text, "", {"reference_deg=[column 1]", "measured_deg=[column 2]"}).story, Not(HasSubstr("clock in")));
  EXPECT_THAT(Take(text).story, HasSubstr("reference <- column 1 [deg]"));
}

TEST_F(Importing, PutsPartsWithAClockEachOneBehindTheOther) {
  std::string text = "test,time [s],reference [deg],measured [deg]\n";
  for (int part = 0; part < 3; ++part) {
    for (int i = 0; i < 100; ++i) text += fmt::format("{},{:.2f},{:.2f},{:.2f}\n", part, 0.02 * i, 3.6 * i, 3.6 * i - 0.01);
  }
  const Imported taken = TakeReadings(300, text);
  EXPECT_NEAR(ToSeconds(taken.readings.back().time - taken.readings.front().time), 3.0 * 99.0 * 0.02 + 2.0, 1e-6) << "with a second between them";
  EXPECT_THAT(taken.story, HasSubstr("begins anew: 3 parts"));
}

TEST_F(Importing, KnowsJulianDates) {
  std::string text = "JD,RA_encoder_deg,RA_error_arcsec,SNR\n";
  for (int i = 0; i < 200; ++i) text += fmt::format("{:.8f},{:.5f},{:.3f},{:.1f}\n", 2460311.3 + 2.0 * i / 86400.0, 0.008 * i, 5.0 * std::sin(0.1 * i), 8.0 + i % 7);
  const Imported taken = Take(text);
  EXPECT_NEAR(ToSeconds(taken.readings.back().time - taken.readings.front().time), 398.0, 0.01);
  EXPECT_THAT(taken.story, HasSubstr("\"RA_error_arcsec\" is taken as the device less the reference"));
}

TEST_F(Importing, KnowsMillisecondsOfADay) {
  std::string text = "ms_today;reference_deg;measured_deg\n";
  for (int i = 0; i < 200; ++i) text += fmt::format("{};{:.5f};{:.5f}\n", 43200000 + 20 * i, 3.6 * i, 3.6 * i + 0.01 * (i % 5));
  const Imported taken = Take(text);
  EXPECT_NEAR(ToSeconds(taken.readings.back().time - taken.readings.front().time), 3.98, 1e-6);
}

/// Of a sine whose rows are missing for a third of a period.
TEST_F(Importing, TakesNoSpeedOverAPause) {
  std::string text = "time_s,reference_deg,measured_deg\n";
  for (int i = 0; i < 1200; ++i) {
    const double t_s = 0.05 * i, phase = t_s / 17.0 * units::turn;
    if (std::fmod(t_s, 20.0) < 6.0) continue;
    text += fmt::format("{:.3f},{:.5f},{:.5f}\n", t_s, 90.0 + 75.0 * std::sin(phase), 90.0 + 75.0 * std::sin(phase));
  }
  for (const Reading& r : Take(text).readings) {
    const double t_s = ToSeconds(r.time) + 6.0, peak_deg_s = 75.0 * units::turn / 17.0;
    EXPECT_NEAR(r.velocity_rad_s / units::deg, peak_deg_s * std::cos(t_s / 17.0 * units::turn), 0.05) << t_s;
  }
}

/// "dwell time" and "cycle time" are of a row, not between rows.
TEST_F(Importing, TakesATimeThatDoesNotGoOnForNoClock) {
  std::string text = "settling_time [ms];stamp;reference [deg];measured [deg]\n";
  for (int i = 0; i < 72; ++i) text += fmt::format("{};{};{};{}\n", 100 + i * 37 % 11, 0.02 * i, 5 * i, 5 * i);
  EXPECT_NEAR(ToSeconds(Take(text).readings.at(50).time), 1.0, 1e-9);
}

TEST_F(Importing, ReadsAScopeWhoseRowsAreStampedWithFileTimes) {
  std::string text = "Starttime of export;132907960342450000;Thursday, March 3, 2022;16:47:14.245\n\nName;fSetPos;fActPos (Resolver)\nData-Type;REAL64;REAL64\n"
                     "SampleTime;10;10\nUnit;(None);(None)\n\n";
  for (int i = 0; i < 200; ++i) text += fmt::format("{};{};{:.4f}\n", 132907960342450000 + 100000 * static_cast<long long>(i), 0.5 * i, 0.5 * i + 0.01);
  const Imported imported = Take(text, "twincat");
  EXPECT_NEAR(ToSeconds(imported.readings.back().time), 1.99, 1e-5) << "10 ms a row";
}

/// Whoever reads the run later has to know it: no drift has a rate there.
TEST_F(Importing, MarksTheReadingsOfAListThatNobodyTimed) {
  std::string list = "reference [deg],measured [deg]\n", timed = "time [s],reference [deg],measured [deg]\n";
  for (int i = 0; i < 72; ++i) {
    list += fmt::format("{},{}\n", 5 * i, 5 * i);
    timed += fmt::format("{},{},{}\n", i, 5 * i, 5 * i);
  }
  EXPECT_TRUE(HasClock(Take(timed).readings)) << "a second a row, as a list counts too";
  const Imported imported = Take(list);
  EXPECT_FALSE(HasClock(imported.readings));
  EXPECT_THAT(imported.story, HasSubstr("no clock: the rows are in order"));
  std::stringstream written;
  WriteReadingsCsv(imported.readings, imported.bench, written);
  EXPECT_FALSE(HasClock(ParseReadingsCsv(written, "readings.csv", imported.bench)));
}

// Speeds are no angles, whatever their units are called.

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
  struct Rates {
    const char* names;
    double table, gyro;
  };
  for (const Rates& in : {Rates{"% Time (s),Gyro Output (rads/s),Input Rate (RPM)", kRpm_deg_s, kRad_deg},
                          Rates{"time [s],gyro output [dps],motor input [r/min]", kRpm_deg_s, 1.0},
                          Rates{"time [s],output rate,input rate", 1.0, 1.0}}) {
    const char* const names = in.names;
    const std::string refusal = MessageOf([&] { Take(Swings(in.names, in.table, in.gyro)); });
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
