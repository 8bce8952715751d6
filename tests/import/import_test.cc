#include "tests/import/importing.h"
#include "tests/import/raw_files.h"
#include "tests/support/kept_text.h"

namespace twinbench::imports {
namespace {

using testing::HasSubstr, testing::Not;

double NoError(double, int) { return 0.0; }

std::string TwoColumns(const char* separator, bool comma) {
  std::string text = fmt::format("Zeit [s]{0}Soll [deg]{0}Ist [deg]\r\n", separator);
  for (const test::AxisSample& s : test::DriveAxis({.turns = 0.5}, NoError)) {
    const std::string row =
        fmt::format("{:.3f}{}{:.4f}{}{:.4f}\r\n", s.time_s, separator, s.angle_deg, separator, s.shown_deg);
    text += comma ? test::WithComma(row) : row;
  }
  return text;
}

TEST_F(Importing, ReadsAnySeparatorAndDecimalMark) {
  for (const auto& [separator, comma] : {std::pair{",", false}, std::pair{";", false}, std::pair{";", true},
                                         std::pair{"\t", true}, std::pair{"\t", false}}) {
    const Imported imported = Take("\xEF\xBB\xBF" + TwoColumns(separator, comma));
    EXPECT_LT(Worst_deg(imported.readings), 0.012) << separator << comma << ": six standard deviations";
    EXPECT_EQ(imported.readings.size(), 4u * (180u + 10u)) << "every row is a reading";
    EXPECT_NEAR(imported.readings[150].velocity_rad_s, 20.0 * units::deg, 1e-3);
  }
}

TEST_F(Importing, SkipsCommentsUnitRowsAndRemarksBetweenRows) {
  std::string text = "# logger 7, 3 channels\n# gain: 5\n\ntime;reference;measured\n[s];[deg];[mrad]\n";
  for (int i = 0; i < 100; ++i) {
    text += fmt::format("{};{};{}\n", 0.1 * i, i, i * units::deg / units::mrad);
    if (i == 40) text += "# somebody walked by\nlink lost\n";
  }
  const Imported imported = TakeReadings(100, text);
  EXPECT_LT(Worst_deg(imported.readings), 1e-9) << "mrad were turned into deg";
  EXPECT_THAT(imported.story, HasSubstr("1 lines of text"));
}

TEST_F(Importing, TakesTheTwoColumnsOfAFileWithoutNamesInTheirOrderAndSaysSo) {
  std::string text;
  for (int i = 0; i < 60; ++i) text += fmt::format("{} {}\n", 6 * i, 6 * i + 0.01);
  const Imported imported = TakeReadings(60, text);
  EXPECT_KEPT(imported.story);
}

/// "position" is also the number of a measuring position: whole, and without a unit.
TEST_F(Importing, TakesAColumnCalledPositionForWhereTheDeviceSaysThatItStands) {
  std::string text = "Command [deg],Position [deg]\n", numbered = "Command,Actual,Position\n";
  for (int i = 0; i < 72; ++i) {
    text += fmt::format("{},{}\n", 5 * i, 5 * i + 0.25);
    numbered += fmt::format("{},{},{}\n", 5 * i, 5 * i + 0.25, i);
  }
  for (const Imported& imported : {Take(text), Take(text, "", {"measured_deg=Position"}), Take(numbered)}) {
    ASSERT_EQ(imported.readings.size(), 72u);
    EXPECT_NEAR(Error_deg(imported.readings[30]), 0.25, 1e-7);
    EXPECT_EQ(imported.readings[30].position, 30);
  }
}

TEST_F(Importing, UnwrapsAndSaysIt) {
  const Imported imported = Take(test::ScopeExport(test::DriveAxis({.turns = 3.0}, NoError)), "twincat");
  EXPECT_THAT(imported.story, HasSubstr("it was unwrapped"));
  EXPECT_LT(Worst_deg(imported.readings), 0.012);
  double high = 0.0;
  for (const Reading& r : imported.readings) high = std::max(high, r.reference_rad);
  EXPECT_NEAR(high, 3.0 * units::turn, 0.01);
}

TEST_F(Importing, OfAScopeExportKeepsTheClockOfEveryGroup) {
  const Imported imported =
      Take(test::ScopeExport(test::DriveAxis({}, NoError)), "twincat", {"temperature_degC=Cabinet"});
  // 0.001 K a second, written down every second; the motion takes 74 s.
  const Reading& late = imported.readings.at(1000);
  EXPECT_NEAR(late.temperature_degC, 21.0 + 0.001 * ToSeconds(late.time), 1e-3);
}

TEST_F(Importing, JoinsChannelsThatAreStampedOneByOne) {
  const auto samples = test::DriveAxis({.speed_deg_s = 10.0, .interval_s = 0.1, .rest_s = 3.0}, NoError);
  const Imported imported = Take(test::CamonitorLog(samples, 0.04), "camonitor");
  EXPECT_NEAR(imported.readings[0].reference_rad / units::deg, 1.4, 0.01) << "not the value of last week";
  // The device is stamped 0.04 s after it was read: 0.4 deg at this speed, forward and backward.
  EXPECT_NEAR(Worst_deg(imported.readings), 0.4, 0.02);
  EXPECT_THAT(imported.story, Says("is taken to the clock of", "3 reversals", "4 rests"));
}

TEST_F(Importing, JoinsTwoFilesWithClocksOfTheirOwn) {
  std::string laser = "time_s,laser_deg\n", device = "stamp_ms\tencoder_deg\n";
  for (const auto& s : test::DriveAxis({.speed_deg_s = 10.0, .interval_s = 0.05}, NoError))
    laser += fmt::format("{:.3f},{:.5f}\n", s.time_s, test::OnceRound(s.angle_deg));
  for (const auto& s : test::DriveAxis({.speed_deg_s = 10.0, .interval_s = 0.08}, NoError))
    device += fmt::format("{:.0f}\t{:.5f}\n", 1000.0 * s.time_s, s.shown_deg);
  const Imported imported = TakeFiles({File("laser.csv", laser), File("device.txt", device)});
  EXPECT_THAT(imported.story, HasSubstr("taken to start together"));
  EXPECT_LT(Worst_deg(imported.readings), 0.9) << "the rests of the two drives begin up to a sample apart";
  EXPECT_GT(imported.readings.size(), 1700u);
}

TEST_F(Importing, SaysByHowMuchClocksOfTwoFilesMissEachOther) {
  std::string a = "time;reference\n", b = "time;measured\n";
  for (int i = 0; i < 50; ++i) {
    a += fmt::format("2021-10-27 09:00:{:02d};{}\n", i, i);
    b += fmt::format("2021-10-27 11:00:{:02d};{}\n", i, i);
  }
  EXPECT_KEPT(MessageOf([&] { TakeFiles({File("a.csv", a), File("b.csv", b)}); }));
  EXPECT_EQ(TakeFiles({File("a.csv", a), File("b.csv", b)}, "[course]\nclock_offset_s = -7200.0\n").readings.size(),
            50u);
}

TEST_F(Importing, PutsGuidePulsesBackIntoWhatTheMountDid) {
  const auto error_arcsec = [](double angle_deg) { return 12.0 * test::Cosine(60.0, angle_deg, 20.0); };
  const Imported imported = Take(test::GuideLog(error_arcsec, 1500));
  EXPECT_THAT(imported.story, HasSubstr("3 rows without"));
  double sum = 0.0, squares = 0.0;
  for (const Reading& r : imported.readings) {
    const double left =
        (r.measured_rad - r.reference_rad) / units::arcsec - error_arcsec(r.reference_rad / units::deg + 0.025);
    sum += left;
    squares += left * left;
  }
  const auto n = static_cast<double>(imported.readings.size());
  // Seeing is 0.1 px of 2 arcsec at declination 30: 0.23 arcsec on the axis; pulses are whole milliseconds.
  EXPECT_LT(std::sqrt(squares / n - sum * sum / n / n), 0.4);
}

TEST_F(Importing, TakesAFirmwaresTableOverItsComments) {
  const auto error = [](double angle_deg, int) { return 0.45 * test::Cosine(1.0, angle_deg, 30.0); };
  const Imported imported = TakeReadings(720, test::FirmwareTable(error, 720), "lookup_table");
  EXPECT_NEAR(Worst_deg(imported.readings), 0.45, 0.01);
  EXPECT_THAT(imported.story, HasSubstr("unwrapped"));
}

TEST_F(Importing, TakesNeighboursOfALargeTableTogetherAndSaysSo) {
  const auto error = [](double angle_deg, int) { return 0.2 * test::Cosine(4.0, angle_deg, 30.0); };
  const Imported imported = Take(test::FirmwareTable(error, 65536), "lookup_table");
  EXPECT_LT(imported.readings.size(), 25000u);
  EXPECT_GT(imported.readings.size(), 12000u);
  EXPECT_NEAR(Worst_deg(imported.readings), 0.2, 0.002);
  EXPECT_THAT(imported.story, HasSubstr("averaged in blocks of up to 4 rows"));
}

TEST_F(Importing, OfAPositioningReportTakesTheRunsInTheOrderOfTheTest) {
  const auto actual_mm = [](double target, int sense, int run) {
    return target + 0.001 * run - (sense < 0 ? 0.012 : 0.0);
  };
  const Imported imported = Take(test::PositioningReport({0.0, 50.1, 99.8, 150.3, 200.2}, 5, actual_mm), "iso230");
  ASSERT_EQ(imported.readings.size(), 50u) << "the tables of results are not taken for readings";
  EXPECT_THAT(imported.story, HasSubstr("a linear axis: 360 mm count as a turn"));
  const Reading& back = imported.readings[5];
  EXPECT_EQ(back.direction, -1);
  EXPECT_EQ(back.position, 4);
  EXPECT_NEAR(back.reference_rad / units::deg, 200.2, 1e-9);
  EXPECT_NEAR(Error_deg(back), 0.001 - 0.012, 1e-9);
}

TEST_F(Importing, TakesRunsSideBySideInMicrometresWithDecimalCommas) {
  std::string text = "Target [mm];1 up [um];1 down [um];2 up [um];2 down [um]\n";
  for (int i = 0; i < 6; ++i) text += fmt::format("{},5;1,0;-11,0;2,0;-10,0\n", 40 * i);
  const Imported imported = TakeReadings(24, text, "iso230");
  EXPECT_NEAR(Error_deg(imported.readings[6]), -0.011, 1e-12);
  EXPECT_EQ(imported.readings[6].direction, -1);
}

TEST_F(Importing, CountsTheSamplesOfHalsampler) {
  const Imported imported =
      Take(test::HalSamples(test::DriveAxis({.turns = 2.0, .speed_deg_s = 90.0, .interval_s = 0.001}, NoError)),
           "halsampler");
  EXPECT_LE(imported.readings.size(), 25000u) << "20000 and a quarter";
  EXPECT_THAT(imported.story, HasSubstr("averaged in blocks"));
  EXPECT_LT(Worst_deg(imported.readings), 0.012);
  EXPECT_NEAR(imported.readings[500].velocity_rad_s, 90.0 * units::deg, 0.01);
}

TEST_F(Importing, MakesOneReadingOfEveryRestOfADriveFromStopToStop) {
  std::string text = "t,reference_deg,measured_deg\n";
  double t = 0.0;
  for (int k = 0; k < 24; ++k) {
    const double here = k < 12 ? 30.0 * k : 30.0 * (23 - k);
    for (int i = 0; i < 30; ++i) text += fmt::format("{:.1f},{},{}\n", t += 0.1, here, here + 0.01 * k);
    if (k != 11 && k != 23)
      for (int i = 1; i < 10; ++i)
        text += fmt::format("{:.1f},{},{}\n", t += 0.1, here + (k < 11 ? 3 : -3) * i, here + (k < 11 ? 3 : -3) * i);
  }
  const Imported imported = Take(text);
  ASSERT_EQ(imported.readings.size(), 23u) << "the turning point is one rest";
  EXPECT_EQ(imported.readings[5].direction, 1);
  EXPECT_EQ(imported.readings[15].direction, -1);
  EXPECT_EQ(imported.readings[5].position, 5);
  EXPECT_NEAR(imported.readings[5].reference_rad / units::deg, 150.0, 1e-9);
  EXPECT_GT(imported.readings[5].dwell_s, 0.5);
  EXPECT_THAT(imported.story, HasSubstr("rows on the way between measuring positions"));
}

TEST_F(Importing, KeepsAWaveOfTheOrderThatItSays) {
  const auto wave = [](double angle_deg, int) { return 0.2 * test::Cosine(40.0, angle_deg, 0.0); };
  std::string text = "time_s,reference_deg,measured_deg\n";
  for (const auto& s : test::DriveAxis(
           {.turns = 4.0, .speed_deg_s = 36.0, .interval_s = 0.001, .passes = {1, -1}, .noise_deg = 0.0}, wave))
    text += fmt::format("{:.4f},{:.6f},{:.6f}\n", s.time_s, s.angle_deg, s.shown_deg);
  const Imported imported = Take(text);
  EXPECT_LT(imported.readings.size(), 25000u);
  double sum = 0.0;
  int count = 0;
  for (const Reading& r : imported.readings) {
    if (r.direction == 0) continue;
    sum += Error_deg(r) * test::Cosine(40.0, r.reference_rad / units::deg, 0.0);
    ++count;
  }
  EXPECT_NEAR(2.0 * sum / count, 0.2, 0.002) << "one part in a hundred";
}

TEST_F(Importing, RefusesADeviceThatDoesNotFollowOneToOne) {
  std::string rad = "time_s,reference_deg,measured_deg\n", dead = rad, noise = rad;
  for (int i = 0; i < 200; ++i) {
    rad += fmt::format("{},{},{}\n", 0.1 * i, i, i * units::deg);
    dead += fmt::format("{},{},7\n", 0.1 * i, i);
    noise += fmt::format("{},{},{}\n", 0.1 * i, i, i % 7);
  }
  for (const std::string& text : {rad, dead, noise}) EXPECT_KEPT(MessageOf([&] { Take(text); }));
}

TEST_F(Importing, TakesADeviceThatCountsTheOtherWayAndSaysSo) {
  std::string against = "time_s,reference_deg,measured_deg\n";
  for (int i = 0; i < 200; ++i) against += fmt::format("{},{},{:.4f}\n", 0.1 * i, i, std::fmod(360.0 + 77.0 - 0.9995 * i, 360.0));
  const Imported imported = Take(against);
  EXPECT_KEPT(imported.assumed.at(0));
  EXPECT_THAT(imported.story, HasSubstr("note: " + imported.assumed.at(0)));
  const std::vector<Reading>& r = imported.readings;
  EXPECT_NEAR(std::remainder(r[100].measured_rad - r[0].measured_rad, units::turn), 99.95 * units::deg, 1e-9);
  EXPECT_TRUE(Take(against, "", {"measured_deg=-[measured_deg]"}).assumed.empty());
}

TEST_F(Importing, TakesAWholeNumberOfTurnsForAGearAndSaysSo) {
  std::string motor = "reference [deg],drive angle [deg]\n", against = "motor [deg],joint [deg]\n";
  for (int i = 0; i < 200; ++i) {
    motor += fmt::format("{},{}\n", 2 * i, 40.02 * i);
    against += fmt::format("{},{}\n", -10 * i, 2 * i);
  }
  const Imported imported = Take(motor), turned = Take(against);
  EXPECT_KEPT(imported.assumed.at(0) + "\n" + turned.assumed.at(0));
  EXPECT_NEAR(imported.readings.back().reference_rad / units::deg, 398.0, 1e-6);
  EXPECT_NEAR(imported.readings.back().measured_rad / units::deg, 398.199, 1e-6) << "what a gear does not explain stays";
  EXPECT_LT(Worst_deg(turned.readings), 1e-9);
  EXPECT_THAT(MessageOf([&] { Take("reference [deg],drive [deg]\n0,0\n1,4.37\n2,8.74\n3,13.11\n"); }), HasSubstr("times 4.37"));
}

TEST_F(Importing, NamesTheColumnsThereAreWhereItCannotChoose) {
  const std::string text = "t,a,b,c\n0,1,2,3\n1,2,3,5\n2,3,4,9\n";
  EXPECT_KEPT(MessageOf([&] { Take(text); }));
  const std::vector<std::string> unknown = {"reference_deg=d", "measured_deg=b"};
  EXPECT_KEPT(MessageOf([&] { Take(text, "", unknown); }));
}

TEST_F(Importing, LooksWithoutDemandingAnything) {
  const std::string file = File("raw.csv", "t,a,b,c\n0,1,2,3\n1,2,3,5\n2,3,4,9\n");
  const Seen seen = Look({file}, {});
  EXPECT_KEPT(seen.text + seen.needs.value().what());
}

TEST_F(Importing, RefusesFilesThatAreNoRecordings) {
  const std::string packed("PK\x03\x04\0\0\0", 7);
  for (const std::string& text : {std::string(), std::string("these are my notes\nof tuesday\n"), packed})
    EXPECT_KEPT(MessageOf([&] { Take(text); }));
  EXPECT_KEPT(MessageOf([&] { TakeFiles({"/nowhere/at/all.csv"}); }));
}

TEST(Map, NamesTheNearestKeyAndTheReadyMaps) {
  for (const char* text : {"[file]\nseperator = \"tab\"\n", "[columns]\nreferenz_deg = \"a\"\n"})
    EXPECT_KEPT(MessageOf([&] { ParseMap(text, "m.toml"); }));
  EXPECT_KEPT(MessageOf([] { LoadMap("phd3"); }));
  Map map;
  EXPECT_KEPT(MessageOf([&] { SetColumn("nonsense_deg=a", map); }));
}

TEST(Map, EveryReadyOneCanBeRead) {
  EXPECT_GE(ReadyMaps().size(), 7u);
  for (const Map& ready : ReadyMaps()) EXPECT_FALSE(LoadMap(ready.name).title.empty()) << ready.name;
  EXPECT_THAT(DescribeMaps(), HasSubstr("TwinCAT"));
}

// The largest radius less the smallest is a result there, which means in blocks would make smaller.
TEST_F(Importing, KeepsEveryRowOfACircleUnlessMeansAreAskedFor) {
  constexpr int kRows = 7000;
  std::string text = "x,y,actual_x,actual_y\n";
  for (int i = 0; i < kRows; ++i) {
    const double angle_rad = 2.0 * units::turn * i / kRows, spike_mm = i == 3210 ? 0.02 : 0.0;
    const double x = 50.0 * std::cos(angle_rad), y = 50.0 * std::sin(angle_rad);
    text += fmt::format("{:.6f},{:.6f},{:.6f},{:.6f}\n", x, y, x + spike_mm, y);
  }
  const std::string map = "bench = \"circular_motion\"\n[columns]\ncommanded_x_mm = \"x\"\ncommanded_y_mm = \"y\"\n"
                          "grid_x_mm = \"actual_x\"\ngrid_y_mm = \"actual_y\"\nfeed_mm_min = \"3000 / 3600000\"\nsetup = \"0\"\n";
  EXPECT_EQ(Take(text, map).readings.size(), static_cast<std::size_t>(kRows));
  const Imported means = Take(text, map + "[average]\nmost_readings = 1000\n");
  EXPECT_LE(means.readings.size(), 1000u);
  EXPECT_THAT(means.story, HasSubstr("largest and smallest values of single rows are lost"));
}

}  // namespace
}  // namespace twinbench::imports
