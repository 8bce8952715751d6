#include "tests/core/any_reading.h"
#include "tests/core/input_error.h"
#include "tests/core/refusals.h"
#include "tests/support/memory_log.h"
#include "tests/support/noise.h"
#include "twin/core/bench_format.h"
#include "twin/core/units.h"

namespace twinbench {
namespace {

using test::TextOf, testing::HasSubstr, testing::Not;

/// Drifts begin with the run, and not half a century before.
TEST(ReadReadingsCsv, CountsTimesSince1970FromTheFirstReading) {
  std::vector<Reading> readings(2, {.target_rad = 0.0, .reference_rad = 0.0, .mean_V = {0.1, 0.1, 0.1, 0.1}});
  readings[1].reading = 1;
  const std::string path = testing::TempDir() + "/since_1970.csv";
  const auto seconds = [&](double first_s) {
    readings[0].time = Time(FromSeconds(first_s)), readings[1].time = Time(FromSeconds(first_s + 3.0));
    WriteReadingsCsv(readings, kRotaryBench, path);
    const std::vector<Reading> read = ReadReadingsCsv(path);
    return std::pair(ToSeconds(read[0].time), ToSeconds(read[1].time));
  };
  EXPECT_EQ(seconds(1.7e9).first, 0.0);
  EXPECT_NEAR(seconds(1.7e9).second, 3.0, 1e-6);  // a double of so many seconds has 0.2 us
  EXPECT_NEAR(seconds(7.5).first, 7.5, 1e-8) << "a run's own clock stays";
}

constexpr const char* kHeader =
    "reading,time_s,setup,pass,direction,position,phase,target_deg,reference_deg,psd_a_x_V,psd_a_y_V,psd_b_x_V,"
    "psd_b_y_V";

std::vector<Reading> ParseReadings(const std::string& text, const std::string& bench = "") {
  std::istringstream in(text);
  return ParseReadingsCsv(in, "r.csv", bench);
}

/// The message about one row under kHeader.
std::string RowError(const std::string& row) {
  return MessageOf([&] { ParseReadings(std::string(kHeader) + "\n" + row + "\n"); });
}

/// What the rotary bench reads.
Reading RotaryReading(int number) {
  Reading r = AnyReading(number);
  r.measured_rad = r.velocity_rad_s = kNaN;
  return r;
}

TEST(ReadingsCsv, AreReadBackToTheSameBits) {
  std::vector<Reading> readings;
  for (int i = 0; i < 300; ++i) readings.push_back(RotaryReading(i));
  for (Reading& r : readings) r.extra = {{"operator", ""}, {"humidity_percent", ""}};
  readings[7].extra = {{"operator", "A, B"}, {"humidity_percent", "41"}};
  const auto read = ParseReadings(TextOf(readings));
  ASSERT_EQ(read.size(), readings.size());
  for (std::size_t i = 0; i < read.size(); ++i) ExpectSame(read[i], readings[i]);
}

class ReadingsOfABench : public testing::TestWithParam<std::string> {};

TEST_P(ReadingsOfABench, AreKnownByTheirColumnsAndComeBackToTheSameBits) {
  const std::vector<ReadingColumn>& columns = FormatOf(GetParam()).columns;
  test::Noise normal(1.0, 4);
  std::vector<Reading> readings(20);
  for (Reading& r : readings) {
    r.reading = static_cast<int>(&r - readings.data());
    if (GetParam() == kEncoderBench) r.direction = r.reading % 3 - 1;
    for (const ReadingColumn& column : columns) {
      if (column.number) column.number(r) = normal();
    }
  }
  std::vector<Reading> again = ParseReadings(TextOf(readings, GetParam()));
  ASSERT_EQ(again.size(), readings.size());
  for (std::size_t i = 0; i < again.size(); ++i) {
    EXPECT_EQ(again[i].status, ReadingStatus::kOk);
    EXPECT_EQ(again[i].direction, readings[i].direction);
    for (const ReadingColumn& column : columns) {
      if (!column.number) continue;
      EXPECT_EQ(column.number(again[i]), column.number(readings[i])) << column.name;
    }
  }
  EXPECT_EQ(TextOf(readings, GetParam()).find("psd_a_x_V") != std::string::npos, GetParam() == kRotaryBench);
}

INSTANTIATE_TEST_SUITE_P(Every, ReadingsOfABench, testing::ValuesIn(BenchNames()));

TEST(ReadingsCsv, KeepTimesToTheNanosecond) {
  for (const std::int64_t ns : {std::int64_t{0}, std::int64_t{1}, std::int64_t{-1}, std::int64_t{883'000'000'000},
                                std::int64_t{9'199'999'999'999'999'999}}) {
    const Reading reading{.time = Time(Duration(ns)), .target_rad = 0.0, .reference_rad = 0.0, .mean_V = {}};
    EXPECT_EQ(ParseReadings(TextOf({reading})).front().time.time_since_epoch().count(), ns);
  }
}

TEST(ReadingsCsv, HaveNoTimeWhereNobodyMeasuredOne) {
  const std::string first = "\n0,,0,0,1,0,full_circle,0,0,1,1,1,1", next = "\n7,,0,0,1,1,full_circle,10,-10,1,1,1,1";
  const std::vector<Reading> readings = ParseReadings(std::string(kHeader) + ",clock" + first + ",none" + next + ",none\n");
  EXPECT_LT(readings[0].time, readings[1].time) << "their order is known";
  const std::string text = TextOf(readings);
  EXPECT_THAT(text, HasSubstr("\n0,,0,"));
  EXPECT_EQ(TextOf(ParseReadings(text)), text);
  EXPECT_THAT(RowError("0,,0,0,1,0,full_circle,0,0,1,1,1,1"), HasSubstr("time_s is \"\"")) << "with a clock there is a time";
}

TEST(ReadingsCsv, OfTheOracleHaveNoOptionalColumns) {
  const auto readings = ReadReadingsCsv(TWINBENCH_TEST_DATA "/oracle/full_circle_reseat.csv");
  ASSERT_EQ(readings.size(), 144u);  // 36 positions, 4 set-ups
  // 1,full_circle,0,0,1,1,887.00,10.0,-10.0,-0.045273009,-0.012127348,-0.040327222,-0.010423659
  ExpectSame(readings[1], {.reading = 1,
                           .time = Time(Duration(887'000'000'000)),
                           .position = 1,
                           .target_rad = 10.0 * units::deg,
                           .reference_rad = -10.0 * units::deg,
                           .mean_V = {-0.045273009, -0.012127348, -0.040327222, -0.010423659}});
}

TEST(ReadingsCsv, KeepColumnsThatWeDoNotKnow) {
  const std::string header = "gripper," + std::string(kHeader) + ",\"air, top\"";
  const auto readings = ParseReadings(header + "\nG7,0,0,0,0,1,0,full_circle,0,0,1,2,3,4,calm\n");
  EXPECT_EQ(readings[0].extra, (std::map<std::string, std::string>{{"air, top", "calm"}, {"gripper", "G7"}}));
  EXPECT_EQ(ParseReadings(TextOf(readings))[0].extra, readings[0].extra);
}

TEST(ReadingsCsv, HaveAStatusOnlyIfSomethingWentWrong) {
  std::vector<Reading> readings = {RotaryReading(0), RotaryReading(1)};
  EXPECT_THAT(TextOf(readings), Not(HasSubstr("status")));
  readings[1].status = ReadingStatus::kSaturated;
  readings[1].mean_V.fill(kNaN);
  readings[1].std_V.fill(kNaN);
  const auto read = ParseReadings(TextOf(readings));
  EXPECT_EQ(read[0].status, ReadingStatus::kOk);
  EXPECT_EQ(read[1].status, ReadingStatus::kSaturated);
  EXPECT_TRUE(std::isnan(read[1].mean_V[0]));
}

TEST(ReadingsCsv, CallAReadingWithAnEmptyVoltageMissing) {
  const auto readings = ParseReadings(std::string(kHeader) + "\n0,0,0,0,1,0,full_circle,0,0,1,,3,4\n");
  EXPECT_EQ(readings[0].status, ReadingStatus::kMissing);
  for (const double mean_V : readings[0].mean_V) EXPECT_TRUE(std::isnan(mean_V));
}

TEST(ReadingsCsv, AreOfTheBenchThatIsStatedOrWhoseColumnsTheyHave) {
  EXPECT_KEPT(MessageOf([] { ParseReadings(std::string(kHeader) + "\n", "rotary_4df"); }));
  EXPECT_KEPT(MessageOf([] { ParseReadings("reading,time_s,setup,pass,direction,position,phase,bar_mm\n"); }));
  std::ostringstream out;
  EXPECT_THROW(WriteReadingsCsv({}, "", out), InputError) << "there is no usual bench";
}

TEST(ReadingsCsv, NameEveryMissingColumnAtOnce) {
  const auto error = [](const std::string& text, const std::string& bench = "") {
    return MessageOf([&] { ParseReadings(text, bench); });
  };
  EXPECT_KEPT(error("# exported\nreading,time_s,setup,pass,position,phase,target_deg,psd_a_x_V,psd_a_y_V\n"));
  EXPECT_KEPT(error("reading,time_s,setup,pass,direction,position,phase,velocity_deg_s\n", kEncoderBench));
}

TEST(ReadingColumns, MayHoldAQuantityWithoutAFieldOfItsOwn) {
  const ReadingColumn bar = ShownColumn("bar_um", units::um, "um", Quantity{"bar_um"});
  Reading reading;
  EXPECT_EQ(bar.print(reading), "") << "not available";
  EXPECT_TRUE(bar.parse(reading, "1.25"));
  EXPECT_DOUBLE_EQ(bar.number(reading), 1.25e-6);
  EXPECT_EQ(bar.print(reading), "1.25");
  bar.number(reading) = kNaN;
  EXPECT_EQ(bar.print(reading), "");
}

TEST(ReadingsCsv, NameLineColumnAndFaultOfABadFieldAndOfReadingsOutOfOrder) {
  const std::string good = "0,5,0,0,1,0,full_circle,0,0,1,2,3,4\n";
  ExpectRefused("r.csv", RowError,
                {{2, "0,0,0,0,1,0,full_circle,0,0,1,x,3,4"}, {2, "0,0,0,0,1,0,full_circle,,0,1,2,3,4"},
                 {2, "0,0,0,0,1,0,full_circle,inf,0,1,2,3,4"}, {2, "0,0,0,0,1,0,fullcircle,0,0,1,2,3,4"},
                 {2, "0,0,0,0,2,0,full_circle,0,0,1,2,3,4"}, {2, "-1,0,0,0,1,0,full_circle,0,0,1,2,3,4"},
                 {2, "0,0,0.5,0,1,0,full_circle,0,0,1,2,3,4"}, {2, "0,soon,0,0,1,0,full_circle,0,0,1,2,3,4"},
                 {2, "0,1e10,0,0,1,0,full_circle,0,0,1,2,3,4"}, {2, "0,0,0,0,1,0,full_circle,0,0,1,2,3"},
                 {3, good + "0,6,0,0,1,0,full_circle,0,0,1,2,3,4"},
                 {3, good + "1,4.5,0,0,1,0,full_circle,0,0,1,2,3,4"}});
  EXPECT_KEPT(MessageOf(
      [&] { ParseReadings(std::string(kHeader) + ",status\n0,0,0,0,1,0,full_circle,0,0,1,2,3,4,fine\n"); }));
}

TEST(ReadingsCsv, SayWhenTheDiskRefuses) {
  EXPECT_THROW(WriteReadingsCsv({}, kRotaryBench, "/no/such/folder/r.csv"), BenchError);
  EXPECT_KEPT(MessageOf([] { ReadReadingsCsv("no_such.csv"); }));
}

TEST(ReadingNames, LeadBackToTheirValues) {
  for (int i = 0; i < kPhases; ++i) EXPECT_EQ(PhaseOf(PhaseName(static_cast<Phase>(i))), static_cast<Phase>(i));
  for (int i = 0; i < kReadingStatuses; ++i) {
    const auto status = static_cast<ReadingStatus>(i);
    EXPECT_EQ(ReadingStatusOf(ReadingStatusName(status)), status);
  }
  EXPECT_EQ(PhaseOf("idle"), std::nullopt);
}

/// A reading as somebody else writes it down, and what it says; NaN: nothing.
struct ForeignReading {
  std::string columns, row;
  std::vector<std::pair<double Reading::*, double>> says;
  ReadingStatus status = ReadingStatus::kOk;
};

constexpr const char *kAngles = "reference_deg,measured_deg",
                     *kTurntable = "turntable_deg,multitooth_deg,autocollimator_x_arcsec,autocollimator_y_arcsec",
                     *kHob = "table_encoder_deg,hob_encoder_deg,head_deg";
constexpr const char* kPlan = "reading,time_s,setup,pass,direction,position,phase,";

TEST(ReadingsCsv, AreKnownByTheirColumnsTakenToSIAndMayLackAValue) {
  const ForeignReading readings[] = {
      {std::string(kAngles) + ",velocity_deg_s", "360.5,0.75,-36",
       {{&Reading::reference_rad, 360.5 * units::deg}, {&Reading::measured_rad, 0.75 * units::deg},
        {&Reading::velocity_rad_s, -36.0 * units::deg}}},
      {kAngles, "1.5,2", {{&Reading::velocity_rad_s, kNaN}}},
      {kAngles, "1.5,", {{&Reading::measured_rad, kNaN}}, ReadingStatus::kMissing},
      {kTurntable, "5,-5,1.25,-60",
       {{&Reading::target_rad, 5.0 * units::deg}, {&Reading::reference_rad, -5.0 * units::deg},
        {&Reading::autocollimator_yaw_rad, 1.25 * units::arcsec}, {&Reading::autocollimator_tilt_rad, -60.0 * units::arcsec}}},
      {kTurntable, "10,-10,,", {{&Reading::autocollimator_yaw_rad, kNaN}}, ReadingStatus::kMissing},
      {std::string(kHob) + ",interferometer_arcsec", "0.5,11,180,2.5",
       {{&Reading::measured_rad, 0.5 * units::deg}, {&Reading::reference_rad, 11.0 * units::deg}, {&Reading::head_rad, 180.0 * units::deg},
        {&Reading::interferometer_rad, 2.5 * units::arcsec}}},
      {std::string(kHob) + ",interferometer_arcsec", ",22,180,", {{&Reading::measured_rad, kNaN}}, ReadingStatus::kMissing},
      {kHob, "0.5,11,180", {{&Reading::interferometer_rad, kNaN}}}};
  for (const auto& [columns, row, says, status] : readings) {
    SCOPED_TRACE(columns + ": " + row);
    const Reading read = ParseReadings(kPlan + columns + "\n0,0.08,0,0,1,0,full_circle," + row + "\n").at(0);
    EXPECT_EQ(read.status, status);
    for (const auto& [number, SI] : says) EXPECT_THAT(read.*number, testing::NanSensitiveDoubleEq(SI));
  }
  const std::string at_rest = std::string(kPlan) + kAngles + "\n0,0.08,0,0,0,0,full_circle,1,1\n";
  EXPECT_EQ(ParseReadings(at_rest)[0].direction, 0);
}

TEST(TurntableReadings, MayCountTheWayBackOfTheMultitoothTableAsPositive) {
  const std::string head = std::string(kPlan) + kTurntable + "\n";
  const auto back = ParseReadings(head + "0,0,0,0,1,0,full_circle,0,10,0,0\n1,2,0,0,1,1,full_circle,5,15,0,0\n");
  EXPECT_DOUBLE_EQ(back[1].reference_rad, -15.0 * units::deg);
  const auto ours = ParseReadings(head + "0,0,0,0,1,0,full_circle,0,10,0,0\n1,2,0,0,1,1,full_circle,5,365,0,0\n");
  EXPECT_DOUBLE_EQ(ours[1].reference_rad, 365.0 * units::deg) << "a turn more is the same tooth";
  const auto neither = ParseReadings(head + "0,0,0,0,1,0,full_circle,0,10,0,0\n1,2,0,0,1,1,full_circle,5,77,0,0\n");
  EXPECT_DOUBLE_EQ(neither[1].reference_rad, 77.0 * units::deg) << "left for the evaluation to refuse";
}

}  // namespace
}  // namespace twinbench
