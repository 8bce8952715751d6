#include "twin/core/reading.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>

#include "tests/core/input_error.h"
#include "twin/benches/names.h"
#include "twin/core/reading_column.h"
#include "twin/core/units.h"

namespace twinbench {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr const char* kHeader =
    "reading,time_s,setup,pass,direction,position,phase,target_deg,reference_deg,psd_a_x_V,psd_a_y_V,psd_b_x_V,"
    "psd_b_y_V";

std::vector<Reading> ParseReadings(const std::string& text) {
  std::istringstream in(text);
  return ParseReadingsCsv(in, "r.csv");
}

std::string Write(const std::vector<Reading>& readings, const std::string& bench = kRotaryBench) {
  std::ostringstream out;
  WriteReadingsCsv(readings, bench, out);
  return out.str();
}

/// The message about one row under kHeader.
std::string RowError(const std::string& row) {
  return MessageOf([&] { ParseReadings(std::string(kHeader) + "\n" + row + "\n"); });
}

Reading AnyReading(int number, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Reading r;
  r.reading = number;
  r.time = Time(Duration(1'000'000'000'000'000'001LL + number));  // 31 years: a double of seconds would lose these
  r.setup = number % 4;
  r.pass = number % 3;
  r.direction = number % 2 ? 1 : -1;
  r.position = number % 36;
  r.phase = static_cast<Phase>(number % kPhases);
  r.n_samples = number % 5 ? 100 : 0;
  for (double* value : {&r.target_rad, &r.reference_rad, &r.dwell_s, &r.temperature_degC, &r.autocollimator_yaw_rad,
                        &r.autocollimator_tilt_rad})
    *value = normal(random);
  for (double& mean_V : r.mean_V) mean_V = normal(random);
  for (double& std_V : r.std_V) std_V = std::abs(normal(random));
  return r;
}

void ExpectEqual(const Reading& a, const Reading& b) {
  EXPECT_EQ(a.reading, b.reading);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.setup, b.setup);
  EXPECT_EQ(a.pass, b.pass);
  EXPECT_EQ(a.direction, b.direction);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.phase, b.phase);
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.n_samples, b.n_samples);
  EXPECT_EQ(a.target_rad, b.target_rad);
  EXPECT_EQ(a.reference_rad, b.reference_rad);
  EXPECT_EQ(a.mean_V, b.mean_V);
  EXPECT_EQ(a.std_V, b.std_V);
  EXPECT_EQ(a.dwell_s, b.dwell_s);
  EXPECT_EQ(a.temperature_degC, b.temperature_degC);
  EXPECT_EQ(a.autocollimator_yaw_rad, b.autocollimator_yaw_rad);
  EXPECT_EQ(a.autocollimator_tilt_rad, b.autocollimator_tilt_rad);
  EXPECT_EQ(a.extra, b.extra);
}

TEST(ReadingsCsv, AreReadBackToTheSameBits) {
  std::mt19937_64 random(3);
  std::vector<Reading> readings;
  for (int i = 0; i < 300; ++i) readings.push_back(AnyReading(i, random));
  readings[7].extra = {{"operator", "A, B"}, {"humidity_percent", "41"}};
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (i != 7) readings[i].extra = {{"operator", ""}, {"humidity_percent", ""}};
  }
  const auto read = ParseReadings(Write(readings));
  ASSERT_EQ(read.size(), readings.size());
  for (std::size_t i = 0; i < read.size(); ++i) ExpectEqual(read[i], readings[i]);
}

TEST(ReadingsCsv, KeepTimesToTheNanosecond) {
  for (const std::int64_t ns : {std::int64_t{0}, std::int64_t{1}, std::int64_t{-1}, std::int64_t{883'000'000'000},
                                std::int64_t{9'199'999'999'999'999'999}}) {
    Reading reading;
    reading.time = Time(Duration(ns));
    reading.target_rad = reading.reference_rad = 0.0;
    reading.mean_V.fill(0.0);
    EXPECT_EQ(ParseReadings(Write({reading})).front().time.time_since_epoch().count(), ns);
  }
}

TEST(ReadingsCsv, OfTheOracleHaveNoOptionalColumns) {
  const auto readings = ReadReadingsCsv(TWINBENCH_TEST_DATA "/oracle/full_circle_reseat.csv");
  ASSERT_EQ(readings.size(), 144u);     // 36 positions, 4 set-ups
  const Reading& second = readings[1];  // 1,full_circle,0,0,1,1,887.00,10.0,-10.0,-0.045273009,-0.012127348,...
  EXPECT_EQ(second.reading, 1);
  EXPECT_EQ(second.phase, Phase::kFullCircle);
  EXPECT_EQ(second.time, Time(Duration(887'000'000'000)));
  EXPECT_EQ(second.target_rad, 10.0 * units::deg);
  EXPECT_EQ(second.reference_rad, -10.0 * units::deg);
  EXPECT_EQ(second.mean_V[0], -0.045273009);
  EXPECT_EQ(second.mean_V[1], -0.012127348);
  EXPECT_TRUE(std::isnan(second.std_V[0]));
  EXPECT_TRUE(std::isnan(second.temperature_degC));
  EXPECT_EQ(second.n_samples, 0);
}

TEST(ReadingsCsv, KeepColumnsThatWeDoNotKnow) {
  const std::string header = "gripper," + std::string(kHeader) + ",\"air, top\"";
  const auto readings = ParseReadings(header + "\nG7,0,0,0,0,1,0,full_circle,0,0,1,2,3,4,calm\n");
  EXPECT_EQ(readings[0].extra, (std::map<std::string, std::string>{{"air, top", "calm"}, {"gripper", "G7"}}));
  EXPECT_EQ(ParseReadings(Write(readings))[0].extra, readings[0].extra);
}

TEST(ReadingsCsv, HaveAStatusOnlyIfSomethingWentWrong) {
  std::mt19937_64 random(4);
  std::vector<Reading> readings = {AnyReading(0, random), AnyReading(1, random)};
  EXPECT_THAT(Write(readings), Not(HasSubstr("status")));
  readings[1].status = ReadingStatus::kSaturated;
  readings[1].mean_V.fill(kNaN);
  readings[1].std_V.fill(kNaN);
  const auto read = ParseReadings(Write(readings));
  EXPECT_EQ(read[0].status, ReadingStatus::kOk);
  EXPECT_EQ(read[1].status, ReadingStatus::kSaturated);
  EXPECT_TRUE(std::isnan(read[1].mean_V[0]));
}

TEST(ReadingsCsv, CallAReadingWithAnEmptyVoltageMissing) {
  const auto readings = ParseReadings(std::string(kHeader) + "\n0,0,0,0,1,0,full_circle,0,0,1,,3,4\n");
  EXPECT_EQ(readings[0].status, ReadingStatus::kMissing);
  for (const double mean_V : readings[0].mean_V) EXPECT_TRUE(std::isnan(mean_V));
}

TEST(ReadingsCsv, NameEveryMissingColumnAtOnce) {
  EXPECT_EQ(
      MessageOf([] {
        ParseReadings("# exported\nreading,time_s,setup,pass,position,phase,target_deg,psd_a_x_V,psd_a_y_V\n");
      }),
      "r.csv:2: required columns are missing: direction, reference_deg, psd_b_x_V, psd_b_y_V; expected readings "
      "of the bench rotary_4dof");
}

TEST(ReadingsCsv, AreOfTheBenchThatIsStated) {
  std::istringstream in(std::string(kHeader) + "\n");
  EXPECT_EQ(MessageOf([&] { ParseReadingsCsv(in, "r.csv", "rotary_4df"); }),
            "r.csv: unknown bench \"rotary_4df\"; expected \"rotary_4dof\", \"encoder_comparison\", "
            "\"turntable_autocollimator\", \"hob_transmission\", \"circular_motion\" or \"freeform_five_axis\"; the "
            "nearest is \"rotary_4dof\"");
  std::ostringstream out;
  EXPECT_THROW(WriteReadingsCsv({}, "", out), InputError) << "there is no usual bench";
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

TEST(ReadingsCsv, WithoutAColumnOfAnyBenchAreRefused) {
  EXPECT_EQ(MessageOf([] { ParseReadings("reading,time_s,setup,pass,direction,position,phase,bar_mm\n"); }),
            "r.csv:1: the columns are those of no known bench; expected readings of rotary_4dof, "
            "encoder_comparison, turntable_autocollimator, hob_transmission, circular_motion, freeform_five_axis");
}

TEST(ReadingsCsv, NameLineColumnAndFaultOfABadField) {
  EXPECT_EQ(RowError("0,0,0,0,1,0,full_circle,0,0,1,x,3,4"),
            "r.csv:2: psd_a_y_V is \"x\"; expected a finite number of V, or nothing");
  EXPECT_EQ(RowError("0,0,0,0,1,0,full_circle,,0,1,2,3,4"),
            "r.csv:2: target_deg is \"\"; expected a finite number");
  EXPECT_EQ(RowError("0,0,0,0,1,0,full_circle,inf,0,1,2,3,4"),
            "r.csv:2: target_deg is \"inf\"; expected a finite number");
  EXPECT_EQ(RowError("0,0,0,0,1,0,fullcircle,0,0,1,2,3,4"),
            "r.csv:2: phase is \"fullcircle\"; expected calibration, full_circle, stability or verification");
  EXPECT_EQ(RowError("0,0,0,0,2,0,full_circle,0,0,1,2,3,4"), "r.csv:2: direction is \"2\"; expected 1 or -1");
  EXPECT_EQ(RowError("-1,0,0,0,1,0,full_circle,0,0,1,2,3,4"),
            "r.csv:2: reading is \"-1\"; expected a whole number, 0 or more");
  EXPECT_EQ(RowError("0,0,0.5,0,1,0,full_circle,0,0,1,2,3,4"),
            "r.csv:2: setup is \"0.5\"; expected a whole number, 0 or more");
  EXPECT_EQ(RowError("0,soon,0,0,1,0,full_circle,0,0,1,2,3,4"),
            "r.csv:2: time_s is \"soon\"; expected seconds since the start of the run");
  EXPECT_EQ(RowError("0,1e10,0,0,1,0,full_circle,0,0,1,2,3,4"),
            "r.csv:2: time_s is \"1e10\"; expected seconds since the start of the run");
  EXPECT_EQ(RowError("0,0,0,0,1,0,full_circle,0,0,1,2,3"), "r.csv:2: 12 fields; expected 13, as in the header");
}

TEST(ReadingsCsv, NameAStatusThatDoesNotExist) {
  EXPECT_EQ(MessageOf([] {
              ParseReadings(std::string(kHeader) + ",status\n0,0,0,0,1,0,full_circle,0,0,1,2,3,4,fine\n");
            }),
            "r.csv:2: status is \"fine\"; expected ok, saturated, no_light, clipped_spot, overrun or missing");
}

TEST(ReadingsCsv, RefuseReadingsOutOfOrder) {
  const std::string first = "0,5,0,0,1,0,full_circle,0,0,1,2,3,4\n";
  EXPECT_EQ(RowError(first + "0,6,0,0,1,0,full_circle,0,0,1,2,3,4"),
            "r.csv:3: reading 0 comes twice; expected every number once");
  EXPECT_EQ(RowError(first + "1,4.5,0,0,1,0,full_circle,0,0,1,2,3,4"),
            "r.csv:3: time_s goes back to 4.5; expected time order");
}

TEST(ReadingsCsv, SayWhenTheDiskRefuses) {
  EXPECT_THROW(WriteReadingsCsv({}, kRotaryBench, "/no/such/folder/r.csv"), BenchError);
  EXPECT_EQ(MessageOf([] { ReadReadingsCsv("no_such.csv"); }),
            "no_such.csv: the file cannot be opened; expected a readable readings.csv");
}

TEST(ReadingNames, LeadBackToTheirValues) {
  for (int i = 0; i < kPhases; ++i) EXPECT_EQ(PhaseOf(PhaseName(static_cast<Phase>(i))), static_cast<Phase>(i));
  for (int i = 0; i < kReadingStatuses; ++i) {
    const auto status = static_cast<ReadingStatus>(i);
    EXPECT_EQ(ReadingStatusOf(ReadingStatusName(status)), status);
  }
  EXPECT_EQ(PhaseOf("idle"), std::nullopt);
}

// --- encoder_comparison ---

constexpr const char* kAngles = "reading,phase,setup,pass,direction,position,time_s,reference_deg,measured_deg";

TEST(AngleReadings, AreKnownByTheirColumns) {
  const auto readings =
      ParseReadings(std::string(kAngles) + ",velocity_deg_s\n0,full_circle,0,0,0,0,0.08,360.5,0.75,-36\n");
  ASSERT_EQ(readings.size(), 1u);
  EXPECT_EQ(readings[0].direction, 0) << "at rest";
  EXPECT_DOUBLE_EQ(readings[0].reference_rad, 360.5 * units::deg);
  EXPECT_DOUBLE_EQ(readings[0].measured_rad, 0.75 * units::deg);
  EXPECT_DOUBLE_EQ(readings[0].velocity_rad_s, -36.0 * units::deg);
  EXPECT_EQ(readings[0].status, ReadingStatus::kOk);
}

TEST(AngleReadings, NeedNoVelocityAndMayLackAValue) {
  const auto readings = ParseReadings(std::string(kAngles) + "\n0,full_circle,0,0,1,0,0,1.5,\n");
  EXPECT_EQ(readings[0].status, ReadingStatus::kMissing);
  EXPECT_TRUE(std::isnan(readings[0].velocity_rad_s));
}

TEST(AngleReadings, NameAllMissingColumns) {
  std::istringstream in("reading,time_s,setup,pass,direction,position,phase,velocity_deg_s\n");
  EXPECT_EQ(MessageOf([&] { ParseReadingsCsv(in, "r.csv", "encoder_comparison"); }),
            "r.csv:1: required columns are missing: reference_deg, measured_deg; expected readings of the bench "
            "encoder_comparison");
}

TEST(AngleReadings, ComeBackToTheSameBits) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  std::vector<Reading> readings(20);
  for (int i = 0; i < 20; ++i) {
    readings[i].reading = i;
    readings[i].direction = i % 3 - 1;
    for (double* value : {&readings[i].reference_rad, &readings[i].measured_rad, &readings[i].velocity_rad_s})
      *value = normal(random);
  }
  const auto again = ParseReadings(Write(readings, kEncoderBench));
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(again[i].direction, readings[i].direction);
    EXPECT_EQ(again[i].reference_rad, readings[i].reference_rad);
    EXPECT_EQ(again[i].measured_rad, readings[i].measured_rad);
    EXPECT_EQ(again[i].velocity_rad_s, readings[i].velocity_rad_s);
  }
  EXPECT_THAT(Write(readings, kEncoderBench), Not(HasSubstr("psd_a_x_V")));
}

constexpr const char* kTurntableHeader =
    "reading,time_s,setup,pass,direction,position,phase,turntable_deg,multitooth_deg,autocollimator_x_arcsec,"
    "autocollimator_y_arcsec\n";

TEST(TurntableReadings, AreKnownByTheirColumnsAndComeBackToTheSameBits) {
  const auto readings = ParseReadings(std::string(kTurntableHeader) + "0,0,0,0,1,0,full_circle,5,-5,1.25,-60\n" +
                                      "1,2,0,0,1,1,full_circle,10,-10,,\n");
  EXPECT_DOUBLE_EQ(readings[0].target_rad, 5.0 * units::deg);
  EXPECT_DOUBLE_EQ(readings[0].reference_rad, -5.0 * units::deg);
  EXPECT_DOUBLE_EQ(readings[0].autocollimator_yaw_rad, 1.25 * units::arcsec);
  EXPECT_DOUBLE_EQ(readings[0].autocollimator_tilt_rad, -60.0 * units::arcsec);
  EXPECT_EQ(readings[1].status, ReadingStatus::kMissing) << "the autocollimator showed nothing";
  const auto again = ParseReadings(Write(readings, kTurntableBench));
  EXPECT_EQ(again[0].autocollimator_yaw_rad, readings[0].autocollimator_yaw_rad);
  EXPECT_EQ(again[1].status, ReadingStatus::kMissing);
}

TEST(TurntableReadings, MayCountTheWayBackOfTheMultitoothTableAsPositive) {
  const std::string head = kTurntableHeader;
  const auto back = ParseReadings(head + "0,0,0,0,1,0,full_circle,0,10,0,0\n1,2,0,0,1,1,full_circle,5,15,0,0\n");
  EXPECT_DOUBLE_EQ(back[1].reference_rad, -15.0 * units::deg);
  const auto ours = ParseReadings(head + "0,0,0,0,1,0,full_circle,0,10,0,0\n1,2,0,0,1,1,full_circle,5,365,0,0\n");
  EXPECT_DOUBLE_EQ(ours[1].reference_rad, 365.0 * units::deg) << "a turn more is the same tooth";
  const auto neither = ParseReadings(head + "0,0,0,0,1,0,full_circle,0,10,0,0\n1,2,0,0,1,1,full_circle,5,77,0,0\n");
  EXPECT_DOUBLE_EQ(neither[1].reference_rad, 77.0 * units::deg) << "left for the evaluation to refuse";
}

constexpr const char* kHobHeader =
    "reading,time_s,setup,pass,direction,position,phase,table_encoder_deg,hob_encoder_deg,head_deg";

TEST(HobReadings, AreKnownByTheirColumnsAndComeBackToTheSameBits) {
  const auto readings = ParseReadings(std::string(kHobHeader) + ",interferometer_arcsec\n" +
                                      "0,0,0,0,1,0,full_circle,0.5,11,180,2.5\n1,2,0,0,0,1,full_circle,,22,180,\n");
  EXPECT_DOUBLE_EQ(readings[0].measured_rad, 0.5 * units::deg);
  EXPECT_DOUBLE_EQ(readings[0].reference_rad, 11.0 * units::deg);
  EXPECT_DOUBLE_EQ(readings[0].head_rad, 180.0 * units::deg);
  EXPECT_DOUBLE_EQ(readings[0].interferometer_rad, 2.5 * units::arcsec);
  EXPECT_EQ(readings[1].status, ReadingStatus::kMissing);
  const auto again = ParseReadings(Write(readings, kHobBench));
  EXPECT_EQ(again[0].measured_rad, readings[0].measured_rad);
  EXPECT_EQ(again[0].head_rad, readings[0].head_rad);
  EXPECT_EQ(again[0].interferometer_rad, readings[0].interferometer_rad);
}

TEST(HobReadings, NeedNoInterferometer) {
  const auto readings = ParseReadings(std::string(kHobHeader) + "\n0,0,0,0,1,0,full_circle,0.5,11,180\n");
  EXPECT_EQ(readings[0].status, ReadingStatus::kOk);
  EXPECT_TRUE(std::isnan(readings[0].interferometer_rad));
}

}  // namespace
}  // namespace twinbench
