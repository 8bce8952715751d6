#include <random>

#include "tests/import/importing.h"
#include "tests/support/kept_text.h"
#include "twin/import/source.h"

/// What columns are called, and the units they are in.
namespace twinbench::imports {
namespace {

using testing::HasSubstr, testing::Not;

/// 72 rows of 5 of the unit a row, the device 1 % too far.
std::string Scaled(const std::string& names, double step = 5.0, const char* separator = ",") {
  std::string text = names + "\n";
  for (int i = 0; i < 72; ++i) text += fmt::format("{:.6f}{}{:.6f}\n", step * i, separator, 1.01 * step * i);
  return text;
}

double Last_deg(const Imported& imported) { return imported.readings.back().reference_rad / units::deg; }

TEST_F(Importing, TakesLengthsInTheUnitsThatPeopleWrite) {
  const std::vector<std::pair<const char*, double>> in_mm = {{"cm", 10.0},    {"dm", 100.0},      {"m", 1000.0}, {"mm", 1.0},
                                                             {"um", 1e-3},    {"µm", 1e-3},       {"nm", 1e-6},  {"inch", 25.4},
                                                             {"in", 25.4},    {"centimetre", 10.0}};
  for (const auto& [unit, mm] : in_mm) {
    const Imported imported = Take(Scaled(fmt::format("distance_set [{0}],distance_measured [{0}]", unit), 0.5));
    EXPECT_NEAR(Last_deg(imported), 35.5 * mm, 1e-9 * mm) << unit << ": a degree a millimetre";
    EXPECT_THAT(imported.story, Not(HasSubstr("is not said"))) << unit;
  }
}

TEST_F(Importing, FindsUnitsWhereverANameHasThem) {
  const std::vector<std::pair<const char*, double>> in_deg = {
      {"Cmd(deg),Pos(deg)", 1.0},           {"CMD [°],POS [°]", 1.0},       {"Soll in Grad,Ist in Grad", 1.0},
      {"target_gon,actual_gon", 0.9},       {"CmdDeg,PosDeg", 1.0},         {"command / arcmin,position / arcmin", 1.0 / 60.0},
      {"ref_degrees,enc_degrees", 1.0},     {"reference mm,measured mm", 1.0}, {"target [turns],actual [turns]", 360.0}};
  for (const auto& [names, deg] : in_deg) EXPECT_NEAR(Last_deg(Take(Scaled(names))), 355.0 * deg, 1e-6) << names;
}

TEST_F(Importing, TakesJointsOfRobotsAndWhatGoesRoundByTwoPiInRad) {
  constexpr double kRad_deg = 1.0 / units::deg;
  EXPECT_NEAR(Last_deg(Take(Scaled("target_q_0,actual_q_0", 0.01))), 0.71 * kRad_deg, 1e-3);
  EXPECT_NEAR(Last_deg(Take(Scaled("target_angle,actual_angle", 0.0873))), 71 * 0.0873 * kRad_deg, 1e-3);
  EXPECT_NEAR(Last_deg(Take(Scaled("target_angle,actual_angle", 0.05))), 71 * 0.05, 1e-9) << "half a turn may be anything";
}

TEST_F(Importing, TakesThePlaceOfAServoAndNotItsGainsOrTorques) {
  std::string text = "MotorCmdKd,MotorCmdKp,MotorCmdTor,MotorCmdPos,MotorFbTor,MotorFbPos,q_m\n";
  for (int i = 0; i < 72; ++i) text += fmt::format("{},{},{},{},{},{},{}\n", i % 2, i % 3, i * i, 5 * i, i, 5 * i + 1, 0.01 * i);
  const std::string story = Take(text).story;
  EXPECT_THAT(story, Says("from \"MotorCmdPos\"", "from \"MotorFbPos\""));
}

TEST_F(Importing, TakesColumnsInOtherLanguagesInAnyOrder) {
  for (const char* names : {"Sollwert [deg];Istwert [deg]", "référence [deg];mesuré [deg]", "目标角度 [deg];实际角度 [deg]",
                            "consigna [deg];medido [deg]", "goal_position [deg];present_position [deg]",
                            "Referência [deg];Saída [deg]", "hedef [deg];ölçülen [deg]", "doel [deg];gemeten [deg]"})
    EXPECT_NEAR(Last_deg(Take(Scaled(names, 5.0, ";"))), 355.0, 1e-6) << names;
  std::string swapped = "Istposition (°);Sollposition (°)\n";
  for (int i = 0; i < 72; ++i) swapped += fmt::format("{};{}\n", 5 * i + 1, 5 * i);
  EXPECT_NEAR(Last_deg(Take(swapped)), 355.0, 1e-9);
}

TEST_F(Importing, TakesSessionsForSetUps) {
  std::string text = "session,reference [deg],measured [deg]\n";
  for (int i = 0; i < 72; ++i) text += fmt::format("{},{},{}\n", 1 + i / 36, 5 * i, 5 * i + i / 36);
  const Imported imported = Take(text);
  EXPECT_EQ(imported.readings.front().setup + 1, imported.readings.back().setup);
}

TEST_F(Importing, RefusesAUnitThatItDoesNotKnow) {
  EXPECT_KEPT(MessageOf([&] { Take(Scaled("reference [furlong],measured [furlong]")); }));
}

TEST_F(Importing, NamesTheUnitThatIsMeant) {
  const auto refusal = [&](const std::string& names) { return MessageOf([&] { Take(Scaled(names)); }); };
  EXPECT_THAT(refusal("reference [dge],measured [deg]"), HasSubstr("inch; the nearest is deg; or a formula"));
  EXPECT_THAT(refusal("reference [deg],measured [arcsce]"), HasSubstr("; the nearest is arcsec;"));
  EXPECT_THAT(refusal("reference [furlong],measured [deg]"), Not(HasSubstr("nearest")));
  EXPECT_THAT(MessageOf([&] { Take(Scaled("reference [deg],measured [deg]"), "[time]\ncolumn = \"reference\"\nunit = \"sce\"\n"); }), HasSubstr("filetime; the nearest is s"));
  EXPECT_THAT(MessageOf([&] { MapWith("", {"time_sce=t"}); }), HasSubstr("the nearest is time_s"));
}

TEST_F(Importing, FindsANameOfTheMapWithoutItsUnitAndOneOfTheFileWithIt) {
  const std::string map = "[file]\nnames = [\"time [ms]\", \"target [mm]\", \"actual [mm]\"]\n[columns]\nreference_mm = \"target\"\n"
                          "measured_mm = \"actual [mm]\"\n";
  std::string text;
  for (int i = 0; i < 72; ++i) text += fmt::format("{}\t{}\t{}\n", 10 * i, 5 * i, 5 * i);
  const Imported imported = Take(text, map);
  EXPECT_NEAR(Last_deg(imported), 355.0, 1e-9);
  EXPECT_NEAR(imported.readings.back().velocity_rad_s / units::deg, 500.0, 1e-6) << "the first name says what the time is in";
}

TEST_F(Importing, TakesCountsByWhatIsStatedOrByThePowerOfTwoAtWhichTheyFollow) {
  std::string stated = "# counts per turn: 4000\nreference [deg],encoder [counts]\n", guessed = "reference [deg],encoder\n",
              neither = "reference [deg],encoder [counts]\n";
  for (int i = 0; i < 72; ++i) {
    stated += fmt::format("{},{}\n", 5 * i, std::lround(4000.0 * i / 72.0));
    guessed += fmt::format("{},{}\n", 5 * i, std::lround(65536.0 * i / 72.0));
    neither += fmt::format("{},{}\n", 5 * i, std::lround(4321.0 * i / 72.0));
  }
  std::string both = "counts per turn = 4000\ncounts told;counts seen\n";
  for (int i = 0; i < 72; ++i) both += fmt::format("{};{}\n", 50 * i, 50 * i + 1);
  EXPECT_NEAR(Last_deg(Take(both)), 71.0 * 50.0 * 360.0 / 4000.0, 1e-9);
  EXPECT_LT(Worst_deg(Take(stated).readings), 360.0 / 4000.0);
  std::string beside = stated;
  beside.replace(beside.find("reference [deg],encoder"), 23, "angle [deg],counts");
  beside.replace(beside.find(" [counts]"), 9, "");
  EXPECT_THAT(Take(beside).story, HasSubstr("measured <- [counts]")) << "an angle may be anybody's, counts are the device's";
  EXPECT_LT(Worst_deg(Take(guessed).readings), 360.0 / 65536.0);
  EXPECT_THAT(Take(guessed).story, HasSubstr("65536 counts per turn"));
  EXPECT_KEPT(MessageOf([&] { Take(neither); }));
}

/// Counts beside the straight line that they should be, both of which go round.
std::string GoesRoundTwice(double counts, bool whole_line) {
  std::string text = "target,data\n";
  for (int i = 0; i < 400; ++i) {
    const double line = std::fmod(i * counts / 200.0, counts);
    text += fmt::format("{},{}\n", whole_line ? std::floor(line) : line, std::fmod(std::floor(line + 0.01 * counts * (1.0 + std::sin(units::turn * i / 200.0))), counts));
  }
  return text;
}

TEST_F(Importing, TakesWhatGoesRoundAtAPowerOfTwoForCounts) {
  for (const double counts : {4096.0, 8192.0, 16384.0, 32768.0}) {
    for (const bool whole_line : {true, false}) {
      const Imported taken = Take(GoesRoundTwice(counts, whole_line));
      EXPECT_THAT(taken.story, HasSubstr(fmt::format("* 360 / {:g}", counts)));
      EXPECT_NEAR(Worst_deg(taken.readings), 3.6, 0.2) << counts;
    }
  }
}

TEST_F(Importing, TakesListsOfAProgramWhoseNamesAreSaid) {
  std::string told = "%% a test\nangle_ref = [", right = "angle_R = [", left = "angle_L = [";
  for (int i = 0; i < 72; ++i) {
    told += fmt::format("{} ", 5 * i);
    right += fmt::format("{} ", 5 * i + 0.25);
    left += fmt::format("{} ", 5 * i - 0.5);
  }
  const Imported taken = TakeReadings(72, told + "];\n" + right + "];\n" + left + "];\n", "", {"measured_deg=angle_L"});
  EXPECT_NEAR(Error_deg(taken.readings.back()), -0.5, 1e-9);
}

TEST_F(Importing, TakesArraysOfAProgramSideBySide) {
  std::string reference = "static const float ref_angle[72] = {", device = "static const float enc_angle[72] = {";
  for (int i = 0; i < 72; ++i) {
    reference += fmt::format("{:.3f}f, ", 5.0 * i);
    device += fmt::format("{:.3f}f, ", 5.0 * i + 0.5 * std::sin(5.0 * i * units::deg));
  }
  const std::string below = "\nint ref_angle[N + 2] =\n  {\n" + reference.substr(reference.find('{') + 1) + "};\nint enc_angle[N + 2] =\n{\n" + device.substr(device.find('{') + 1) + "};\n";
  for (const std::string& text : {"#pragma once\n" + reference + "};\n" + device + "};\n", below + "#else" + below}) {
    const Imported taken = Take(text);
    EXPECT_THAT(taken.story, HasSubstr("2 arrays in a program text, 72 entries each"));
    EXPECT_NEAR(Worst_deg(taken.readings), 0.5, 0.002);
  }
}

/// Columns of a table cost what the maps look for in each of them: minutes, of as many as these.
TEST_F(Importing, ReadsALongLineOfNumbersAsTheListThatItIs) {
  constexpr int kEntries = 16384;
  std::string list;
  for (int i = 0; i < kEntries; ++i)
    list += fmt::format("{}{}", i > 0 ? ", " : "", (std::lround(36000.0 * i / kEntries + 31.0 * std::sin(units::turn * i / kEntries)) + 7100) % 36000);
  for (const std::string& text : {"const uint16_t lookup[] = {" + list + "};\n", list + "\n"}) {
    EXPECT_TRUE(BeginOfTable(File("lookup.cpp", text)).tracks.empty());
    const Imported taken = TakeReadings(kEntries, text);
    EXPECT_NEAR(Worst_deg(taken.readings), 0.31, 0.006) << "half of 1/100 deg";
  }
}

TEST_F(Importing, TakesListsOfPythonAndMatlabSideBySide) {
  std::string python = "import numpy as np\nset_mm = [", python_shown = "\nmeasured_mm = [None, ", matlab = "% stroke\nclc;\nset_mm = [0:10:190];\nmeasured_mm = [";
  for (int i = 0; i < 20; ++i) {
    python += fmt::format("{}{}", 10 * i, i < 19 ? ", " : "]");
    if (i > 0) python_shown += fmt::format("{:.2f}{}", 10.1 * i, i < 19 ? ", " : "]\nplt.plot(set_mm, measured_mm)\n");
    matlab += fmt::format("{:.2f}{}", 10.1 * i, i == 9 ? "; ...\n" : i < 19 ? "; " : "];\n");
  }
  for (const std::string& text : {python + python_shown, matlab}) {
    const Imported taken = Take(text);
    EXPECT_THAT(taken.story, Says("2 arrays in a program text, 20 entries each", "measured_mm [mm]"));
    EXPECT_NEAR(taken.readings.back().measured_rad / taken.readings.back().reference_rad, 1.01, 1e-9);
    EXPECT_EQ(taken.readings.size(), text == matlab ? 20u : 19u);
  }
}

/// As a machine's or a laser's display prints them.
TEST_F(Importing, TakesNamesWithBlanksBetweenWideGapsAndRunsBesideACounter) {
  std::string blocks, runs = "Step,Calibrated length (mm),1st (mm),2nd (mm),3rd (mm)\n";
  for (const char* way : {"forward", "reverse"}) {
    blocks += fmt::format("Run 1 {}\nTarget (mm)  Error (um)\n", way);
    for (int i = 0; i < 30; ++i) blocks += fmt::format("{:10.3f}{:10.2f}\n", way[0] == 'f' ? 12.5 * i : 12.5 * (29 - i), i == 7 ? 1.5 : 0.5);
  }
  for (int i = 0; i < 22; ++i) {
    const double shown_mm = 20.0 * i + (i == 7 ? 0.001 : 0.0);
    runs += fmt::format("{},{:.4f},{:.4f},{:.4f},{:.4f}\n", i + 1, 20.0 * i, shown_mm, shown_mm, shown_mm);
  }
  EXPECT_NEAR(Worst_deg(Take(blocks).readings), 0.001 * 29.0 / 30.0, 1e-7) << "of the mean";
  EXPECT_NEAR(Worst_deg(Take(runs).readings), 0.001 * 21.0 / 22.0, 1e-7);
  EXPECT_THAT(Take(runs).story, HasSubstr("22 targets and 3 runs"));
}

TEST_F(Importing, TakesCountsOfAScaleThatErrsAndOfAMotorBehindAGear) {
  std::string scale = "angle [deg],encoder counts\n", gear = "angle [deg],motor counts\n";
  for (int i = 0; i < 72; ++i) {
    scale += fmt::format("{},{}\n", 5 * i, std::lround(1.016 * 4096.0 * i / 72.0));
    gear += fmt::format("{},{}\n", 5 * i, std::lround(1.0003 * 20.0 * 4096.0 * i / 72.0));
  }
  EXPECT_THAT(Take(scale).story, HasSubstr("4096 counts per turn, the power of two at which it follows; +1.6 % that it is off"));
  EXPECT_NEAR(Take(scale).readings.back().measured_rad / units::deg, 355.0 * 1.016, 0.1);
  EXPECT_THAT(Take(gear).story, HasSubstr("81920 counts per turn, at which it follows: taken as a motor's behind a gear"));
  EXPECT_LT(Worst_deg(Take(gear).readings), 0.12);
}

TEST_F(Importing, FindsCountsPerTurnInNamesAndInSentences) {
  for (const char* head : {"reference [deg],encoder [4000 counts/rev]\n", "reference [deg],encoder_4000cpr\n",
                           "# an encoder of 4000 counts per revolution, on the shaft\nreference [deg],encoder [counts]\n",
                           "% 4000 ticks/turn\nreference [deg],encoder ticks\n",
                           "# graph of an actuator, counts of 4000 a turn\nreference [deg],encoder [count]\n",
                           "# resolution: 4000 per rev\nreference [deg],encoder [counts]\n"}) {
    std::string text = head;
    for (int i = 0; i < 72; ++i) text += fmt::format("{},{}\n", 5 * i, std::lround(4000.0 * i / 72.0));
    EXPECT_LT(Worst_deg(Take(text).readings), 360.0 / 4000.0) << head;
  }
}

/// A count is no degree, whatever else is not said.
TEST_F(Importing, AsksHowManyCountsMakeATurn) {
  EXPECT_KEPT(MessageOf([&] { Take(Scaled("TargetCounts [count],EncoderPosition [count]")); }));
  std::string text = "Time,TargetCounts,EncoderPosition\n";
  for (int i = 0; i < 72; ++i) text += fmt::format("{},{},{}\n", 0.1 * i, 5 * i, 5 * i + i % 3);
  EXPECT_THAT(MessageOf([&] { Take(text); }), HasSubstr("\"TargetCounts\" is in counts, and nothing says how many of them make a turn"));
}

TEST_F(Importing, TakesAStepTestInCountsAndSaysHowManyItThinksMakeATurn) {
  std::string text = "Time [s],TargetCounts [count],EncoderPosition [count]\n";
  for (int i = 0; i < 200; ++i) text += fmt::format("{:.2f},700,{}\n", 0.02 * i, i < 20 ? 35 * i : 700 + i % 4);
  const Imported imported = Take(text);
  EXPECT_NEAR(imported.readings.back().reference_rad / units::deg, 700.0 * 360.0 / 1024.0, 1e-9);
  EXPECT_THAT(imported.story, HasSubstr("nothing says how many counts make a turn, taken as 1024 counts per turn"));
  EXPECT_EQ(imported.readings.size(), 180u) << "20 are of the way there";
}

TEST_F(Importing, TakesWholeNumbersOfAServoForCountsAndSaysIt) {
  std::string text = "time [s],goal_position,present_position\n";
  for (int i = 0; i < 200; ++i) text += fmt::format("{:.2f},{},{}\n", 0.02 * i, 2048 + 10 * (i % 100), 2048 + 10 * (i % 100) + i % 3);
  const Imported imported = Take(text);
  EXPECT_NEAR(imported.readings.at(0).reference_rad / units::deg, 180.0, 1e-9);
  EXPECT_THAT(imported.story, HasSubstr("taken as 4096 counts per turn"));
  EXPECT_THAT(imported.story, Not(HasSubstr("taken as deg")));
}

/// A date behind the last name, and a tab at the end of each row.
TEST_F(Importing, AsksNothingForColumnsThatHaveNoName) {
  std::string text = "%Time (s)\tHubangle(Theta in rad)\tTip Deflection (m)\tPosition Reference (rad)\t%4/12/201711:23 AM\n";
  for (int i = 0; i < 72; ++i) text += fmt::format("{:.2f}\t{:.3f}\t{:.4f}\t{:.3f}\t{}\t{}\n", 0.01 * i, 0.05 * i + 0.001, 0.001 * (i % 7), 0.05 * i, i % 2, i % 3);
  EXPECT_THAT(Take(text).story, HasSubstr("measured <- Hubangle [rad]"));
}

/// Without its first line a guide log is of no kind that is known; its columns are.
TEST_F(Importing, NamesTheReadyMapWhoseColumnsAreAllThere) {
  std::string text = "Guiding Begins at 2024-05-06 20:22:52\nPixel scale = 2.1 arc-sec/px, Binning = 1\nMount = Sim,  connected, xRate = 5.2, yRate = 5.1\nDec = 10.5 deg, Hour angle = 1.2 hr\n"
                     "Frame,Time,mount,dx,dy,RARawDistance,DECRawDistance,RADuration,RADirection,SNR\n";
  for (int i = 1; i < 60; ++i) text += fmt::format("{},{:.2f},\"Mount\",{:.2f},{:.2f},{:.2f},{:.2f},{},{},{}\n", i, 2.0 * i, 0.1 * (i % 5), 0.1 * (i % 3), 0.2 * (i % 7), 0.1 * (i % 4), 10 * (i % 4), i % 2 ? "W" : "E", 20 + i % 6);
  EXPECT_THAT(MessageOf([&] { Take(text); }), HasSubstr("; of a PHD2 guide log: tracking of the right ascension axis: --map phd2"));
}

TEST_F(Importing, SaysThatReadingsAreTooFewToNameACause) {
  const auto readings = [](int rows) {
    std::string text = "reference [deg],measured [deg]\n";
    for (int i = 0; i < rows; ++i) text += fmt::format("{},{}\n", 30 * i, 30 * i + i % 2);
    return text;
  };
  EXPECT_THAT(Take(readings(7)).story, HasSubstr("note: 7 readings are too few to name a cause: diagnose takes 8 at least"));
  EXPECT_THAT(Take(readings(8)).story, Not(HasSubstr("too few")));
}

TEST_F(Importing, TakesTheDeviceOfTheAxisThatTheReferenceIsOf) {
  std::string text = "time [s],pos (1) [deg],target pos (2) [deg],pos (2) [deg],load (2)\n";
  for (int i = 0; i < 72; ++i) text += fmt::format("{},7,{},{},{}\n", i, 5 * i, 5 * i + 0.01 * (i % 3), i % 5);
  EXPECT_LT(Worst_deg(Take(text).readings), 0.011);
  text = "time [s],pos (1) [deg],target pos (2) [deg],pos (2) [deg]\n";
  for (int i = 0; i < 72; ++i) text += fmt::format("{},{},{},{}\n", i, 100 - i, 5 * i, 5 * i + 0.01 * (i % 3));
  EXPECT_LT(Worst_deg(Take(text).readings), 0.011);
  EXPECT_THAT(Take(text).story, HasSubstr("\"pos (2)\", by its name, one of 2 such"));
}

TEST_F(Importing, KeepsColumnsOfOneNameApart) {
  EXPECT_NEAR(Last_deg(Take(Scaled("angle,angle"))), 355.0, 1e-6);
  EXPECT_KEPT(Take(Scaled("angle,angle")).story);
}

/// A row of units that nobody knows is no row of names.
TEST_F(Importing, RefusesUnknownUnitsBelowTheNames) {
  EXPECT_THAT(MessageOf([&] { Take(Scaled("reference,measured\nbananas,bananas")); }), HasSubstr("\"reference\" is in \"bananas\""));
}

TEST_F(Importing, AddsAColumnOfErrorsToTheAngleBesideIt) {
  std::string text = "angle [deg];error [arcsec]\n";
  for (int i = 0; i < 72; ++i) text += fmt::format("{};{}\n", 5 * i, 36 * (i % 3));
  const Imported imported = Take(text);
  EXPECT_NEAR(Error_deg(imported.readings.at(5)), 0.02, 1e-9);
  EXPECT_THAT(imported.story, HasSubstr("less the reference"));
}

/// "angle [deg]" at 5 deg a row, and beside it a wave of half a degree, in rad, under the name given.
std::string AngleAnd(const char* name, const char* before = "", const char* cell = "") {
  std::string text = fmt::format("{}angle [deg],{} [rad]\n", before, name);
  for (int i = 0; i < 72; ++i) text += fmt::format("{}{},{:.8f}\n", fmt::format(fmt::runtime(cell), i), 5 * i, 0.5 * std::sin(5.0 * i * units::deg) * units::deg);
  return text;
}

TEST_F(Importing, TakesOffsetsCorrectionsAndResidualsByTheirSense) {
  for (const char* name : {"offset", "error", "deviation", "residual", "Abweichung"}) {
    const Imported imported = Take(AngleAnd(name));
    EXPECT_NEAR(Error_deg(imported.readings.at(18)), 0.5, 1e-6) << name << "\n" << imported.story;
  }
  const Imported corrected = Take(AngleAnd("correction"));
  EXPECT_NEAR(Error_deg(corrected.readings.at(18)), -0.5, 1e-6) << "a correction has the other sign";
  EXPECT_KEPT(Take(AngleAnd("offset")).story);
  EXPECT_KEPT(corrected.story);
}

/// A time, a row's number and a direction are neither the angle nor the device.
TEST_F(Importing, FindsAnAngleAndItsOffsetAmongOtherColumns) {
  for (const auto& [before, cell] : std::vector<std::pair<const char*, const char*>>{{"index,", "{},"}, {"time [s],", "{},"}, {"direction,", "1,"}}) {
    EXPECT_NEAR(Error_deg(Take(AngleAnd("offset", before, cell)).readings.at(18)), 0.5, 1e-6) << before;
  }
  std::string text = "angle,error\n";
  for (int i = 0; i < 72; ++i) text += fmt::format("{},0.{}\n", i, i % 3);
  EXPECT_NEAR(Last_deg(Take(text)), 71.0, 1e-9) << "1 deg a row beside an error is no row's number";
}

/// Random angles beside large steps: their difference, unwrapped, would go wherever the steps go.
TEST_F(Importing, RefusesAColumnThatHasNothingToDoWithItsReference) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> anywhere(0.0, 360.0);
  std::string text = "reference [deg];measured [deg]\n";
  for (int i = 0; i < 200; ++i) text += fmt::format("{:.2f};{:.2f}\n", 91.3 * i, anywhere(random));
  EXPECT_THAT(MessageOf([&] { Take(text); }), HasSubstr("does not follow"));
}

/// Torques, speeds and temperatures that are "commanded" or "measured" too.
TEST_F(Importing, LeavesOtherQuantitiesAside) {
  std::string text = "t [s];commanded velocity [deg/s];commanded;measured current [A];measured;measured temp [degC]\n";
  for (int i = 0; i < 72; ++i) text += fmt::format("{};5;{};{};{};{}\n", i, 5 * i, 0.1 * (i % 7), 5 * i + 0.1, 20 + 0.01 * i);
  EXPECT_LT(Worst_deg(Take(text).readings), 1e-9);
}

/// What a controller sends out to its motor is no command of a place, and a newton metre no nanometre.
TEST_F(Importing, TakesTheSetPointOfAControllerAndNotItsTorque) {
  std::string text = "time [s],set_point,process_value,process_value_dot,command,measured_effort,drive cmd [Nm]\n";
  for (int i = 0; i < 72; ++i) text += fmt::format("{},{},{},{},{},{},{}\n", i, 5 * i, 5 * i + 0.1, 4 + i % 2, i * i % 7, i % 11, i % 5);
  EXPECT_LT(Worst_deg(Take(text).readings), 1e-9);
}

TEST_F(Importing, TakesTheDeviceOfRollForTheMotorOfRoll) {
  std::string text = "imu_pitch_deg,imu_roll_deg,motor_roll_pos_deg,motor_pitch_pos_deg\n";
  for (int i = 0; i < 72; ++i) text += fmt::format("{},{},{},{}\n", i * i % 50, 5 * i + 0.1, 5 * i, i * i % 51);
  EXPECT_LT(Worst_deg(Take(text).readings), 1e-9);
}

TEST_F(Importing, TakesADistanceWithoutAUnitForALength) {
  const Imported imported = Take(Scaled("distance_set,distance_measured", 10.0));
  EXPECT_THAT(imported.story, Says("a linear axis", "its unit is not said and taken as mm"));
}

/// What the message proposes leaves the error of the scale, here 1 %, where it is.
TEST_F(Importing, ProposesTheRatioOfTwoUnitsAndNotTheOneThatWasFound) {
  std::string text = "reference [deg],measured [deg]\n";
  for (int i = 0; i < 72; ++i) text += fmt::format("{},{:.6f}\n", 5 * i, 0.00101 * 5 * i);
  EXPECT_THAT(MessageOf([&] { Take(text); }), HasSubstr("/ 0.001\""));
}

/// What is real is the truth where nothing is called a command or a device.
TEST_F(Importing, TakesTheRealPlaceForTheReferenceOfSensors) {
  std::string text = "z_real_mm,side_avg_mm,top_avg_mm\n";
  for (int i = 0; i < 24; ++i) text += fmt::format("{0},{1},{1}\n", 50 * i, 50 * i + 8);
  EXPECT_THAT(MessageOf([&] { Take(text); }), HasSubstr("as in --column 'measured_mm=[side_avg_mm]',"));
  EXPECT_LT(Worst_deg(Take(text, "", {"measured_mm=side_avg_mm"}).readings), 1e-9);
}

/// The unit in the middle of a name, which goes into a formula as it is; of these columns the first alone is called no device.
TEST_F(Importing, TakesNamesWithBracketsOfTheirOwn) {
  std::string text = "Z-Coordinate;Measured Z [m] - Run 1;Measured Z [m] - Run 2\n";
  for (int i = 0; i < 24; ++i) text += fmt::format("{0};{1:.4f};{1:.4f}\n", 5 * i, 2.0 - 0.005 * i);
  const std::vector<std::string> columns = {"reference_mm=[Z-Coordinate]", "measured_m=-[Measured Z [m] - Run 1]"};
  EXPECT_LT(Worst_deg(Take(text, "", columns).readings), 1e-9);
  EXPECT_LT(Worst_deg(Take(text).readings), 1e-9);
}

/// A reference, a device and a third column, or two that are alike.
std::string Beside(const std::string& third, const std::string& names = "reference [deg];measured [deg]") {
  std::string text = names + ";" + third + "\n";
  for (int i = 0; i < 72; ++i) {
    const std::string value = fmt::format("{}", 20 + 0.25 * (i % 5));
    text += fmt::format("{};{};{}\n", 5 * i, 5 * i + 0.1, third.find(';') < third.size() ? value + ";" + value : value);
  }
  return text;
}

TEST_F(Importing, TakesATemperatureWhateverItIsCalled) {
  for (const char* name : {"Temperature [°C]", "Air temperature [°C]", "T [°C]", "Temp. [°C]", "temp_C", "T_air [°C]", "T_chamber",
                           "Temperatur (°C)", "température (°C)", "scale temperature"})
    EXPECT_EQ(Take(Beside(name)).readings.at(3).temperature_degC, 20.75) << name;
  EXPECT_THAT(Take(Beside("T1 [°C];T2 [°C]")).story, HasSubstr("the first of 2"));
}

TEST_F(Importing, LeavesAsideWhatAUnitAtTheEndOfANameSaysToBeNoAngle) {
  for (const char* third : {"iq_A", "supply_V", "torque_Nm", "humidity"})
    EXPECT_LT(Worst_deg(Take(Beside(third, "theta_ref_rad;theta_motor_rad")).readings), 1e-9) << third;
}

TEST_F(Importing, TakesATargetAndWhereItSettledForAComparison) {
  EXPECT_LT(Worst_deg(Take(Beside("comment", "target_deg;settled_deg")).readings), 1e-9);
}

TEST_F(Importing, TakesADeviationThatGoesWithTheReferenceForTheDevice) {
  EXPECT_LT(Worst_deg(Take(Beside("iq_A", "ref_deg;dev_deg")).readings), 1e-9);
}

TEST_F(Importing, TakesAUnitOfTimeForTheNameOfAClock) {
  std::string text = "ms\tcmd\tact\n";
  for (int i = 0; i < 72; ++i) text += fmt::format("{}\t{}\t{}\n", 10 * i, 5 * i, 5 * i + 0.1);
  EXPECT_NEAR(ToSeconds(Take(text).readings.at(71).time), 0.71, 1e-9);
}

TEST_F(Importing, TakesColumnsInAnyOrderOfTheOptions) {
  const std::vector<std::string> columns = {"temperature_degC=c", "reference_deg=a", "measured_deg=b"};
  EXPECT_EQ(Take(Beside("c", "a;b"), "", columns).readings.at(3).temperature_degC, 20.75);
}

}  // namespace
}  // namespace twinbench::imports
