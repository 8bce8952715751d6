#include "tests/import/importing.h"

/// Files whose names do not say which columns are one axis: what the columns hold says it.
namespace twinbench::imports {
namespace {

using testing::AllOf, testing::HasSubstr, testing::Not;

double Azimuth_deg(double time_s) { return 80.0 * std::sin(0.11 * time_s); }
double Elevation_deg(double time_s) { return 30.0 - 30.0 * std::cos(0.07 * time_s); }

/// Seconds since 1970 with gaps, azimuth and elevation that are shown 50 ms late, where they should be, their rates, an empty field.
std::string Tracking() {
  std::string text;
  double time_s = 0.0;
  for (int i = 0; i < 900; ++i) {
    time_s += i % 100 == 99 ? 0.9 : 0.2 + 0.001 * (i % 3);
    text += fmt::format("{:.5f}, {:.4f}, {:.4f}, {:.4f}, {:.4f}, {:.4f}, \n", 1652493229.0 + time_s, Azimuth_deg(time_s - 0.05), Elevation_deg(time_s - 0.05),
                        Azimuth_deg(time_s), Elevation_deg(time_s), 8.8 * std::cos(0.11 * time_s));
  }
  return text;
}

TEST_F(Importing, TakesColumnsThatGoTogetherWhereNothingHasAName) {
  const Imported first = Take(Tracking());
  EXPECT_THAT(first.story, HasSubstr("reference <- column 4 [deg]\n  measured <- column 2 [deg]"));
  EXPECT_THAT(first.story, HasSubstr("clock: column 1 [s since 1970]"));
  EXPECT_THAT(first.story, HasSubstr("2 axes are in the file (1: \"column 2\" against \"column 4\", 2: \"column 3\" against \"column 5\"): 1 is taken"));
  Map second;
  second.course.axis_number = 2;
  EXPECT_THAT(Import({File("raw.txt", Tracking())}, second).story, HasSubstr("reference <- column 5 [deg]\n  measured <- column 3 [deg]"));
}

/// A robot that follows at once and too far: what stands exactly still between moves is the command.
TEST_F(Importing, TakesWhatStandsStillForTheCommand) {
  std::string text;
  for (int i = 0; i < 400; ++i) {
    const double at_rad = i < 150 ? 1.1 : i < 250 ? 1.1 + 0.004 * (i - 150) : 1.5;
    text += fmt::format("{:.3f},{:.6f},{:.5f},{:.3f}\n", 0.008 * i, at_rad + 0.03 * (at_rad - 1.3) + 1e-5 * ((i * i) % 3), at_rad, 5.0 * std::cos(0.3 * i));
  }
  EXPECT_THAT(Take(text).story, HasSubstr("reference <- column 3 [deg]\n  measured <- column 2 [deg]"));
  EXPECT_THAT(Take(text).story, HasSubstr("taken as deg (in rad: --column 'measured_rad=[column 2]')"));
}

/// A square wave goes together with the motor row by row in no way; that the third channel is their difference says it, and that rows
/// in which a motor is on its way are motion.
TEST_F(Importing, TakesTwoChannelsOfWhichAThirdIsTheDifference) {
  std::string text = "Channel 1,Channel 2,Channel 3,Channel 4\n";
  double shown_deg = 0.0;
  for (int i = 0; i < 2400; ++i) {
    const double set_deg = (i / 300) % 2 == 0 ? 0.0 : 90.0;
    shown_deg += (set_deg - shown_deg) / 40.0;
    text += fmt::format("{:.2f},{:.2f},{:.2f},{:.2f}\n", shown_deg, set_deg, set_deg - shown_deg, 2.0 * (set_deg - shown_deg));
  }
  const Imported imported = Take(text);
  EXPECT_THAT(imported.story, HasSubstr("reference <- Channel 2 [deg]\n  measured <- Channel 1 [deg]"));
  EXPECT_THAT(imported.story, HasSubstr("taken as motion that was read 100 times a second"));
}

/// A circle's sides go together a quarter of a turn later, joints of a walking machine elsewhere, and joints of two names may by chance.
TEST_F(Importing, TakesNoColumnsThatAreNotOneAxis) {
  std::string circle, legs, joints = "time,waist_pos,shoulder_pos,elbow_pos\n";
  for (int i = 0; i < 300; ++i) {
    circle += fmt::format("{:.3f} {:.3f} {:.3f}\n", std::sin(0.1 * i), 20.0 * std::sin(0.1 * i), std::cos(0.1 * i));
    legs += fmt::format("{:.3f} {:.3f} {:.3f}\n", 0.8 + 0.3 * std::sin(0.1 * i), -1.4 - 0.3 * std::sin(0.1 * i), 0.6 + 0.29 * std::sin(0.1 * i));
    joints += fmt::format("{:.2f},{:.3f},{:.3f},{:.3f}\n", 0.01 * i, 50.0 * std::sin(0.02 * i), 50.2 * std::sin(0.02 * i + 0.01), 9.0 * std::cos(0.3 * i));
  }
  EXPECT_THAT(MessageOf([&] { Take(circle); }), HasSubstr("is not clear"));
  EXPECT_THAT(MessageOf([&] { Take(legs); }), HasSubstr("is not clear"));
  EXPECT_THAT(MessageOf([&] { Take(joints); }), HasSubstr("\"shoulder_pos\" and \"waist_pos\" go together: --column 'reference_deg=[shoulder_pos]'"));
}

TEST_F(Importing, ReadsTheSentenceOfALogThatComesMostOften) {
  std::string text = "Hello Computer!\nmotor 2 ready\n";
  for (int i = 0; i < 60; ++i) {
    text += fmt::format("[12:00:{:02d}.250] joint 2: moved to {:.2f} deg, encoder shows {:.2f} deg (off by {:.2f})\n", i, 3.0 * i, 3.0 * i + 0.1 * std::sin(i), 0.1 * std::sin(i));
    if (i % 9 == 0) text += "still 5 to go, or 7\n";
  }
  const Imported imported = TakeReadings(60, text);
  EXPECT_THAT(imported.story, HasSubstr("measured <- encoder shows [deg]"));
  EXPECT_NEAR(imported.readings[20].reference_rad / units::deg, 60.0, 1e-9);
}

/// Volts in steps of a sentence without names: the difference of two sensors and both.
TEST_F(Importing, ReadsASentenceWithoutNamesByItsDifference) {
  std::string text;
  for (int i = 0; i < 80; ++i) text += fmt::format("Sensor difference: {:.2f} = {:.2f} - {:.2f}\n", 0.05 * i, 2.05 * i, 2.0 * i);
  EXPECT_THAT(Take(text).story, HasSubstr("\"column 2\""));
}

TEST_F(Importing, ReadsListsAndRowsOfNumbersOfAProgramWhateverTheyAreCalled) {
  const std::string pairs = "coord_t toAngle[5] = \n{\n  {0.0000, -15},\n {10.1, -5.0},\n {20.2, 5.2}, {29.9, 15.1}, {40.0, 25.0}\n};\nint n = 5;\n";
  EXPECT_THAT(Take(pairs).story, HasSubstr("reference <- toAngle.0 [deg]\n  measured <- toAngle.1 [deg]"));
  const std::string lists = "p = [188 208 228 248 268];\nu = [188.2 208.1 228.3 248.2 268.4];\na = sin(p);\n";
  EXPECT_THAT(Take(lists).story, HasSubstr("reference <- p [deg]\n  measured <- u [deg]"));
  const std::string servo = "pwm_us = [1100 1300 1500 1700 1900];\nangle_deg = [30.1 14.9 0.2 -15.1 -29.8];\n";
  EXPECT_THAT(MessageOf([&] { Take(servo); }), HasSubstr("--column 'reference_deg=[pwm_us] * -0.0749 + 112.41' is the straight line from it"));
}

/// Any large ratio is near a whole number.
TEST_F(Importing, TakesNoGearWhereOneSideIsInAnotherUnit) {
  std::string text = "a,b\n";
  for (int i = 0; i < 40; ++i) text += fmt::format("{},{:.4f}\n", 10 * i, 10.0 * i / 85.3);
  EXPECT_THAT(MessageOf([&] { Take(text); }), HasSubstr("measured_deg follows reference_deg times 0.0117"));
}

TEST_F(Importing, LeavesOutTheWayToAPlaceThatIsNotFar) {
  std::string text = "Time,Target,X Position\n";
  for (int i = 0; i < 400; ++i) text += fmt::format("{:.2f},1,{:.5f}\n", 0.02 * i, 0.97 * (1.0 - std::exp(-0.05 * i)) + 0.0002 * (i % 3));
  EXPECT_THAT(Take(text).story, HasSubstr("rows at the beginning, on the way to the only place"));
  EXPECT_THAT(MessageOf([&] { Take("Speed,Target,Real,Gyro\n25,90,87,88\n50,90,89,89\n75,90,90,88\n100,90,91,87\n"); }), HasSubstr("the reference never moves"));
}

/// Whose an angle is its name does not say: it is where the other was sent if it goes by even steps.
TEST_F(Importing, TakesAnAngleOfEvenStepsForTheReferenceOfWhatDoesNot) {
  std::string text = "Pot (deg),Angle (deg)\n", other = "angle,sensor\n";
  for (int i = 0; i < 60; ++i) {
    text += fmt::format("{:.2f},{}\n", 5.0 * i + std::sin(0.1 * i * i), 5 * i);
    other += fmt::format("{:.2f},{}\n", 5.0 * i + std::sin(0.1 * i * i), 5 * i);
  }
  EXPECT_THAT(Take(text).story, HasSubstr("reference <- Angle [deg]\n  measured <- Pot [deg]"));
  EXPECT_THAT(Take(other).story, HasSubstr("measured <- sensor"));
}

TEST_F(Importing, SaysHowAnErrorByTheTimeAloneIsTaken) {
  std::string text = "Time(s),RA error (arcsec)\n";
  for (int i = 0; i < 300; ++i) text += fmt::format("{:.3f},{:.3f}\n", 2.0 * i, 5.0 * std::cos(0.02 * i));
  const std::string reference = "reference_arcsec=time_s*15.041", measured = "measured_arcsec=time_s*15.041+[RA error]";
  EXPECT_THAT(MessageOf([&] { Take(text); }), AllOf(HasSubstr(reference), HasSubstr(measured)));
  EXPECT_NEAR(Worst_deg(Take(text, "", {reference, measured}).readings), 5.0 / 3600.0, 1e-4);
}

// Two files that are the two sides of one comparison, without a clock or names that would say so.

/// 40 rows of `columns` angles; each column another course, `off` further.
std::string Matrix(int columns, double off) {
  std::string text;
  for (int i = 0; i < 40; ++i) {
    for (int c = 0; c < columns; ++c) text += fmt::format("{}{:.4f}", c > 0 ? " " : "", (20.0 + 5.0 * c) * std::sin(1.3 * i + c) + off * (c + 1));
    text += "\n";
  }
  return text;
}

/// The mean of measured - reference [deg].
double Mean_deg(const Imported& taken) {
  double sum = 0.0;
  for (const Reading& r : taken.readings) sum += Error_deg(r);
  return sum / static_cast<double>(taken.readings.size());
}

TEST_F(Importing, TakesMatricesOfJointsByTheNamesOfTheirFiles) {
  const std::string measured = File("measured_joints.txt", Matrix(3, 0.1)), sent = File("generated_joints.txt", Matrix(3, 0.0));
  for (const auto& files : {std::vector{measured, sent}, std::vector{sent, measured}}) {
    const Imported taken = TakeFiles(files);
    ASSERT_EQ(taken.readings.size(), 40u);
    EXPECT_NEAR(Mean_deg(taken), 0.1, 1e-3);
    EXPECT_THAT(taken.story, HasSubstr("row by row"));
  }
  EXPECT_NEAR(Mean_deg(TakeFiles({sent, measured}, "[course]\naxis_number = 3\n")), 0.3, 1e-3);
  EXPECT_NEAR(Mean_deg(TakeFiles({sent, measured}, "", {"reference_deg=[1:column 2]", "measured_deg=[2:column 2]"})), 0.2, 1e-3);
}

TEST_F(Importing, TakesAListBesideAListAndAListBesideATable) {
  std::string sent, came;
  for (int i = 0; i < 40; ++i) {
    sent += fmt::format("{}{}", i > 0 ? "," : "", 7 * i);
    came += fmt::format("{}{:.2f}", i > 0 ? "," : "", 7 * i + 0.25);
  }
  EXPECT_NEAR(Mean_deg(TakeFiles({File("a.csv", sent), File("b.csv", came)})), 0.25, 1e-9) << "the first is the reference";
  EXPECT_NEAR(Mean_deg(TakeFiles({File("position_actual.csv", came), File("position_set.csv", sent)})), 0.25, 1e-9);
  const std::vector<std::string> files = {File("protractor.txt", Matrix(1, 0.0)), File("joints.txt", Matrix(3, 0.1))};
  const std::string refusal = MessageOf([&] { TakeFiles(files); });
  EXPECT_THAT(refusal, HasSubstr("--column 'reference_deg=[entry]' --column 'measured_deg=[2:column 1]'"));
  EXPECT_NEAR(Mean_deg(TakeFiles(files, "", {"reference_deg=[entry]", "measured_deg=[2:column 1]"})), 0.1, 1e-3) << "as the message has it";
}

/// Both were written at the same instants, some of which are missing; a table of angles beside readings is no clock.
TEST_F(Importing, TakesTheColumnThatTwoFilesHaveInCommonForTheirClock) {
  std::string sent, came, table, again;
  for (int i = 0; i < 400; ++i) {
    const double t = 0.01 * i + (i > 200 ? 0.5 : 0.0);
    sent += fmt::format("{:.2f},{:.4f}\n", t, 10.0 * std::sin(t));
    came += fmt::format("{:.2f},{:.4f}\n", t, 10.0 * std::sin(t - 0.02));
  }
  const Imported taken = TakeFiles({File("u.txt", sent), File("y.txt", came)});
  EXPECT_THAT(taken.story, HasSubstr("motion that is read while it goes on"));
  EXPECT_EQ(taken.readings.size(), 400u);
  for (int i = 0; i < 36; ++i) {
    table += fmt::format("{},{:.2f}\n", 10 * i, 10 * i + 0.1);
    again += fmt::format("{},{:.2f}\n", 10 * i, 10 * i + 0.2);
  }
  EXPECT_EQ(TakeFiles({File("first.txt", table), File("second.txt", again)}).readings.back().setup, 1) << "two mountings";
}

/// A device that is 12 rows late, in lists: 100 a second until somebody says how often they were read.
TEST_F(Importing, TakesListsAtAStatedRateOrBesideTheirTimesForMotion) {
  std::string t = "t = [", sent = "set = [", came = "actual = [";
  for (int i = 0; i < 400; ++i) {
    t += fmt::format("{:.2f}, ", 0.02 * i);
    sent += fmt::format("{:.4f}, ", 10.0 * std::sin(0.1 * i));
    came += fmt::format("{:.4f}, ", 10.0 * std::sin(0.1 * (i - 12)));
  }
  const std::string lists = sent + "]\n" + came + "]\n";
  EXPECT_THAT(Take(lists).story, AllOf(HasSubstr("taken as motion"), HasSubstr("12 rows later: taken as motion that was read 100 times a second; --column 'rate_Hz=100'")));
  EXPECT_THAT(Take(lists, "[course]\nkind = \"stops\"\n").story, AllOf(HasSubstr("12 rows later"), Not(HasSubstr("taken as motion"))));
  EXPECT_THAT(Take(lists, "", {"rate_Hz=50"}).story, AllOf(HasSubstr("motion that is read while it goes on"), HasSubstr("50 Hz")));
  EXPECT_THAT(Take(t + "]\n" + lists).story, AllOf(HasSubstr("motion that is read while it goes on"), HasSubstr("50 Hz")));
  EXPECT_THAT(MessageOf([&] { Take(lists, "", {"rate_Hz=often"}); }), HasSubstr("a number above 0"));
}

/// One row late on a smooth profile is behind by its speed; behind by the same at any speed is play, which stops have too.
TEST_F(Importing, TakesRowsWithoutAClockForMotionWhereTheDeviceIsBehindByItsSpeed) {
  const auto table_of = [](double rows, double play) {
    std::string table = "set,actual\n";
    for (int i = 0; i < 400; ++i)
      table += fmt::format("{:.4f},{:.3f}\n", 10.0 * std::sin(0.1 * i), 10.0 * std::sin(0.1 * (i - rows)) - std::copysign(0.5 * play, std::cos(0.1 * i)));
    return table;
  };
  EXPECT_THAT(Take(table_of(0.8, 0.3)).story, AllOf(HasSubstr("by its speed, about 0.8 rows: taken as motion"), HasSubstr("while it goes on")));
  EXPECT_THAT(Take(table_of(0.0, 1.2)).story, HasSubstr("taken as stops"));
}

}  // namespace
}  // namespace twinbench::imports
