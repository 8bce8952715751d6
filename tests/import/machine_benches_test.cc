#include "tests/import/importing.h"
#include "tests/support/noise.h"

// Files of machine benches under names that no map lists, as controllers, laser interferometers and probes write them.
namespace twinbench::imports {
namespace {

using testing::Contains, testing::HasSubstr;

constexpr int kRowsATurn = 2000;

/// Once round 50 mm about (40, 30) mm at 2000 rows a turn; the actual places lag by ten rows.
double Place_mm(int k, int axis) {
  const double angle_rad = units::turn * k / kRowsATurn;
  return axis == 0 ? 40.0 + 50.0 * std::cos(angle_rad) : 30.0 + 50.0 * std::sin(angle_rad);
}

class CircleByItsPlaces : public Importing {
 protected:
  static void Expect(const Imported& taken, const char* map) {
    const Quantity x_m{"commanded_x_mm"}, y_m{"commanded_y_mm"};
    EXPECT_EQ(taken.bench, "circular_motion");
    EXPECT_THAT(taken.story, HasSubstr(fmt::format("taken as --map {}", map)));
    ASSERT_GT(taken.readings.size(), 1500U) << taken.story;
    for (const Reading& r : taken.readings) ASSERT_NEAR(std::hypot(x_m(r), y_m(r)) / units::mm, 50.0, 1e-3);
    EXPECT_EQ(taken.readings.front().direction, 1);
  }
};

TEST_F(CircleByItsPlaces, MayBeLinesOfNamesAndNumbersByTurns) {
  std::string text = "Sampling period is 2000000 nSec \n\n";
  const auto comma = [](double x) {
    std::string number = fmt::format("{:+.8f}", x);
    std::ranges::replace(number, '.', ',');
    return number;
  };
  for (int k = 0; k < kRowsATurn; ++k)
    text += fmt::format("joint.0.motor-pos-cmd {} joint.0.motor-pos-fb {} joint.1.motor-pos-cmd {} joint.1.motor-pos-fb {} \n", comma(Place_mm(k, 0)),
                        comma(Place_mm(k - 10, 0)), comma(Place_mm(k, 1)), comma(Place_mm(k - 10, 1)));
  const Imported taken = Take(text);
  Expect(taken, "xy_log");
  EXPECT_THAT(taken.story, HasSubstr("rows every 0.002 s"));
  EXPECT_THAT(taken.set, Contains(HasSubstr("feeds_mm_min=[4710")));  // 50 mm * 2 pi in 4 s
}

TEST_F(CircleByItsPlaces, NeedsNoNamesAndTakesTheRateThatIsSaid) {
  std::string text;
  for (int k = 0; k < kRowsATurn; ++k)  // a little off the circle, and before the commanded ones
    text += fmt::format("{} {:.6f} {:.6f} {:.6f} {:.6f}\n", k, Place_mm(k - 10, 0) + 1e-4 * std::sin(40.0 * k), Place_mm(k, 0), Place_mm(k - 10, 1), Place_mm(k, 1));
  Expect(Take(text), "grid");
  const Imported taken = Take(text, "", {"rate_Hz=500"});
  Expect(taken, "xy_log");
  EXPECT_THAT(taken.story, HasSubstr("\"column 3\" and \"column 5\" go round a circle: taken as commanded"));
}

TEST_F(CircleByItsPlaces, IsABallBarsWhereNothingSaysWhereAxesWereSent) {
  std::string text = "Time(msec),POSF X(mm),POSF Y(mm)\n";
  for (int k = 0; k < kRowsATurn; ++k) text += fmt::format("{},{:.7f},{:.7f}\n", 2 * k, Place_mm(k, 0), Place_mm(k, 1) + 0.01 * (Place_mm(k, 0) - 40.0) / 50.0);
  const Imported taken = Take(text);
  Expect(taken, "measured_circle");
  const Quantity bar_m{"bar_um"};
  for (const Reading& r : taken.readings)  // an axis that is askew: 5 um sin(2 angle)
    ASSERT_NEAR(bar_m(r) / units::um, 5.0 * std::sin(2.0 * std::atan2(Quantity{"commanded_y_mm"}(r), Quantity{"commanded_x_mm"}(r))), 0.02);
}

/// A line is a piece of a large circle, and a scale that bends of a smaller one.
TEST_F(CircleByItsPlaces, IsNoneInTwoColumnsThatGoTogether) {
  test::Noise noise_mm(0.02, 3);
  std::string text = "time [s],reference [mm],measured [mm]\n";
  for (int k = 0; k < 1500; ++k) {
    const double at_mm = -20.0 + 0.03 * k;
    text += fmt::format("{:.1f},{:.5f},{:.5f}\n", 0.1 * k, at_mm, 49.0 + at_mm + 1e-3 * at_mm * at_mm + noise_mm());
  }
  EXPECT_EQ(Take(text).bench, "encoder_comparison");
}

TEST_F(CircleByItsPlaces, IsNoneInATableOfAFewRows) {
  const Imported taken = Take(
      "Circle closure, readings in arc seconds\nPosition;0°;120°;240°\n0;1.0;1.5;0.8\n120;1.2;0.9;1.1\n240;0.7;1.3;1.4\n");
  EXPECT_EQ(taken.bench, "turntable_autocollimator") << taken.story;
  EXPECT_EQ(taken.readings.size(), 9U) << "a column a clamping, called by its angle";
}

class TargetsOfALaser : public Importing {};

TEST_F(TargetsOfALaser, AreAPositioningTest) {
  std::string text = "HEADER:: \nFile Version: 2\n\nTARGET DATA:: \nFiletype: Rotary\nTarget-count: 13\nTargets : \n";
  for (int k = 0; k < 13; ++k) text += fmt::format("{:10.4f}{}", 30.0 * k, k % 5 == 4 ? "\n" : " ");
  text += "\nFlags: 1 1 1\n\nUSER-TEXT:: \nAxis:C\nUnits: arcseconds\n\nRUNS:: \nRun-count: 2\n\nDEVIATIONS:: \nRun Target Data: \n";
  for (const int run : {1, 2})
    for (int k = 0; k < 13; ++k) text += fmt::format("{:4d}{:5d}{:12.4f}\n", run, run == 1 ? k + 1 : 13 - k, 0.5 * (run == 1 ? k : 12 - k) + run);
  const Imported taken = TakeReadings(26, text + "\nENVIRONMENT:: \nAir temp : 20.1\nEOF:: \n");
  for (const Reading& r : taken.readings) {
    const double run = r.direction > 0 ? 1.0 : 2.0;
    EXPECT_NEAR((r.measured_rad - r.reference_rad) / units::arcsec, 0.5 * r.reference_rad / units::deg / 30.0 + run, 1e-3);
  }
}

class ShaftsOfAGear : public Importing {};

TEST_F(ShaftsOfAGear, MayBeOneAndItsTransmissionError) {
  std::string text = "Gear rotation [deg];TE [µrad];\n";
  for (int k = 0; k < 720; ++k) text += fmt::format("{};{:.2f};\n", 0.5 * k, 60.0 * std::sin(k * 0.5 * units::deg));
  const Imported taken = TakeReadings(720, text);
  EXPECT_NEAR(taken.readings[180].measured_rad - taken.readings[180].reference_rad, 60e-6, 1e-8);
}

/// A motor goes on for turns; what it drives stays within one, and says that both are in rad.
TEST_F(ShaftsOfAGear, AreInRadWhereOneStaysWithinATurn) {
  std::string text = "timestamp,motor_position,load_position\n";
  for (int k = 0; k < 3000; ++k) text += fmt::format("{:.3f},{:.6f},{:.7f}\n", 0.01 * k, 100.0 * 2.1e-3 * k, 2.1e-3 * k + 1e-4 * std::sin(0.21 * k));
  const Imported taken = Take(text);
  EXPECT_EQ(taken.bench, "hob_transmission") << taken.story;
  EXPECT_THAT(taken.story, HasSubstr("\"motor_position\" is not said and taken as rad"));
  EXPECT_THAT(taken.set, Contains("transmission.gear_teeth=100"));
}

class ProbesOfASpindle : public Importing {};

TEST_F(ProbesOfASpindle, AreAtTheAngleThatIndexPulsesCount) {
  std::string text = "Time(s),X(um),Y(um),Index\n";
  for (int k = 0; k < 500; ++k)
    text += fmt::format("{:.4f},{:.4f},{:.4f},{}\n", 0.001 * k, 5.0 * std::cos(k * units::turn / 100.0), 5.0 * std::sin(k * units::turn / 100.0), k % 100 == 7 ? 1 : 0);
  const Imported taken = TakeReadings(500, text);
  EXPECT_EQ(taken.bench, "rotary_4dof") << taken.story;
  EXPECT_NEAR(taken.readings[132].target_rad / units::deg, 90.0, 1e-6);
  EXPECT_THAT(taken.story, HasSubstr("counted from the pulse of each turn"));
}

TEST_F(ProbesOfASpindle, AreReversedInARunThatIsSaidToBe) {
  std::string text = "run,angle_deg,displacement_um,std_um\n";
  for (const int run : {1, 2})
    for (int k = 0; k < 36; ++k) text += fmt::format("{},{},{:.4f},0.01\n", run, 10 * k, std::cos(20.0 * k * units::deg) + (run == 1 ? 0.5 : -0.5) * std::sin(30.0 * k * units::deg));
  const Imported taken = TakeReadings(72, text, "", {"reversed=run - 1"});
  EXPECT_EQ(taken.readings.front().setup, 0);
  EXPECT_EQ(taken.readings.back().setup, 1) << "of one mounting, however many runs";
}

class BallsInColumns : public Importing {
 protected:
  const std::string text_ = [] {
    std::string text = "C_deg,dx1_um,dy1_um,dz1_um,dx2_um,dy2_um,dz2_um\n";
    for (int k = 0; k < 24; ++k) {
      const double c = 15.0 * k * units::deg, s = std::sin(c);
      text += fmt::format("{},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f}\n", 15 * k, 18.0 - 18.0 * std::cos(c), 18.0 * s, 0.1, 12.0 - 12.0 * std::cos(c), 12.0 * s, 0.2);
    }
    return text;
  }();
};

TEST_F(BallsInColumns, StandBelowEachOther) {
  const Imported taken = TakeReadings(48, text_, "pose_table", {"x_mm=150", "z_mm=50 + 200 * (ball - 1)"});
  EXPECT_NE(taken.readings.front().setup, taken.readings.back().setup);
  EXPECT_NEAR(Quantity{"z_mm"}(taken.readings.back()) / units::mm, 250.0, 1e-9);
  EXPECT_NEAR(Quantity{"dz_um"}(taken.readings.back()) / units::um, 0.2, 1e-9);
}

TEST_F(BallsInColumns, AreRefusedWhereNobodySaysWhereTheyStand) {
  EXPECT_THAT(MessageOf([this] { (void)Evaluated(Take(text_)); }), HasSubstr("of 2 balls none says where it stands"));
}

class TableOfFaces : public Importing {};

/// What is called clockwise first is read as the rows go.
TEST_F(TableOfFaces, HasEachWayRoundInItsOwnOrder) {
  std::string text = "Face,Table angle,Polygon deviation (\"),CW reading 1 (\"),CCW reading 1 (\")\n";
  for (int k = 0; k < 12; ++k) text += fmt::format("{},{}°00'00\",{:.2f},{:.2f},{:.2f}\n", k + 1, 30 * k, 0.1 * k, 0.1 * k + 1.0, 0.1 * k + 1.2);
  const Imported taken = TakeReadings(24, text);
  for (std::size_t i = 1; i < 24; ++i) {
    const Reading &r = taken.readings[i], &before = taken.readings[i - 1];
    const double way_rad = r.pass == before.pass ? r.target_rad - before.target_rad : r.direction;
    EXPECT_GT(r.direction * way_rad, 0.0) << i;
  }
}

TEST_F(TableOfFaces, OrASweepMayBeInAngularSeconds) {
  std::string text = "#;Angle Measuring Table (angular seconds);DAC X (angular seconds);Trend (angular seconds)\n";
  for (int k = 0; k < 20; ++k) text += fmt::format("{};{:.2f};{:.3f};{:.3f}\n", k + 1, 50.0 * k, 500.0 - 50.4 * k, 500.0 - 50.4 * k);
  const Imported taken = TakeReadings(20, text);
  EXPECT_THAT(taken.story, HasSubstr("taken as --map autocollimator_sweep"));
  EXPECT_NEAR(taken.readings[1].target_rad / units::arcsec, 50.0, 1e-9);
}

}  // namespace
}  // namespace twinbench::imports
