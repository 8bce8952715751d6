#include "tests/import/importing.h"

// Recordings of ball bars as people have them: other names, units, marks and orders of the same circle.
namespace twinbench::imports {
namespace {

using testing::HasSubstr, testing::Not;

constexpr double kDeg = std::numbers::pi / 180.0;

/// An ellipse, 2 um higher counter-clockwise: what a reading is tells which it is.
double Deviation_um(double angle_deg, int direction) {
  return 3.0 * std::sin(2.0 * angle_deg * kDeg) + (direction > 0 ? 2.0 : 0.0) + 0.01 * angle_deg;
}

using Row = std::function<std::string(double angle_deg, int direction)>;

/// Once round each way, or part of it.
std::string Circles(const Row& row, const std::function<std::string(int direction)>& above = [](int) { return ""; }, int arc_deg = 360) {
  std::string text;
  for (const int direction : {1, -1}) {
    text += above(direction);
    for (int k = 0; k < arc_deg; k += 5) text += row(direction > 0 ? k + 0.5 : arc_deg - k - 0.5, direction);
  }
  return text;
}

/// @param form  Of 0 the angle in deg, 1 the deviation in um, 2 the way's sign, 3 its word, 4 its number.
std::string Circles(const std::string& form, const char* ccw = "CCW", const char* cw = "CW") {
  return Circles([&](double a, int d) { return fmt::format(fmt::runtime(form), a, Deviation_um(a, d), d, d > 0 ? ccw : cw, d > 0 ? 1 : 2); });
}

using BarOfAngle = std::function<double(double angle_deg, int direction)>;

/// Every reading is the one that the file has, on a circle of this radius at this feed.
/// @param turn_um  By which the bar may differ, for a turn more.
void ExpectCircles(const Imported& taken, double radius_mm, double feed_mm_min, std::size_t readings, const BarOfAngle& bar_um,
                   double turn_um = std::numeric_limits<double>::infinity()) {
  const Quantity x_m{"commanded_x_mm"}, y_m{"commanded_y_mm"}, feed_m_s{"feed_mm_min"}, bar_m{"bar_um"};
  EXPECT_EQ(taken.bench, "circular_motion");
  ASSERT_EQ(taken.readings.size(), readings) << taken.story;
  for (const Reading& r : taken.readings) {
    const double angle_deg = std::atan2(y_m(r), x_m(r)) / kDeg;
    EXPECT_NEAR(std::hypot(x_m(r), y_m(r)) / units::mm, radius_mm, 1e-6);
    EXPECT_NEAR(feed_m_s(r) * 60.0 / units::mm, feed_mm_min, 1e-6);
    const double away_um = bar_m(r) / units::um - bar_um(angle_deg < -1e-9 ? angle_deg + 360.0 : angle_deg, r.direction);
    ASSERT_LT(std::abs(std::remainder(away_um, turn_um)), 2e-3) << angle_deg << taken.story;
  }
}

class BallBar : public Importing {
 protected:
  static void Expect(const Imported& taken, double radius_mm, double feed_mm_min, std::size_t readings = 144) {
    ExpectCircles(taken, radius_mm, feed_mm_min, readings, Deviation_um);
    EXPECT_NE(taken.readings.front().pass, taken.readings.back().pass);
  }
};

TEST_F(BallBar, IsGuessedByAnAngleAndADeviationInALength) {
  const Imported taken = Take("run,direction,angle_deg,deviation_um\n" + Circles("{4},{2},{0},{1:.4f}\n"));
  Expect(taken, 150.0, 1000.0);
  EXPECT_THAT(taken.story, HasSubstr("taken as --map ball_bar"));
  EXPECT_THAT(taken.story, HasSubstr("the radius is not stated: taken as 150 mm"));
  EXPECT_THAT(taken.story, HasSubstr("the feed is not stated: taken as 1000 mm/min"));
}

/// What comes again in a pass the other way is the angle, not the row.
TEST_F(BallBar, NumbersItsPlacesByTheirAngles) {
  std::string text = "angle [deg];CCW [um];CW [um]\n";
  for (int k = 0; k < 360; k += 5) text += fmt::format("{};{:.4f};{:.4f}\n", k, Deviation_um(k, 1), Deviation_um(k, -1));
  const Imported taken = TakeReadings(144, text);
  EXPECT_EQ(taken.readings[10].position, taken.readings[133].position) << "50 deg, and back at 50 deg";
}

TEST_F(BallBar, MayBeGermanWithConditionsAboveAndDirectionsInWords) {
  const auto comma = [](std::string text) {
    std::ranges::replace(text, '.', ',');
    return text;
  };
  const Imported taken = Take("Kreisformtest\nRadius [mm];100,000\nVorschub [mm/min];500,0\nEbene;XY\nTemperatur [°C];20,3\nKoeffizient;11,5\nMaschine;7\n\n"
                              "Winkel [°];Abweichung [mm];Richtung\n" +
                              Circles([&](double a, int d) { return comma(fmt::format("{};{:.7f};{}\n", a, Deviation_um(a, d) / 1000.0, d > 0 ? "CCW" : "CW")); }));
  Expect(taken, 100.0, 500.0);
  EXPECT_NEAR(taken.readings[0].temperature_degC, 20.3, 1e-12);
  EXPECT_THAT(taken.story, Not(HasSubstr("is not stated")));
}

TEST_F(BallBar, MayHaveABlockForEachWayRoundAndItsFeedAboveIt) {
  const Imported taken = Take(
      "# ball bar, XY, R = 4 inch\n" +
      Circles([](double a, int d) { return fmt::format("{:.9f}\t{:.4f}\n", a * kDeg, Deviation_um(a, d)); },
              [](int d) { return fmt::format("Run {}: {}, feed rate 1 m/min\ntheta (rad)\tdR (um)\n", d > 0 ? 1 : 2, d > 0 ? "counter-clockwise" : "clockwise"); }));
  Expect(taken, 101.6, 1000.0);
}

TEST_F(BallBar, MayHaveAColumnForEachWayRound) {
  std::string text = "nominal radius: 100 mm\nfeed rate: 2000 mm/min\nAngle [deg],CCW [um],CW [um]\n";
  for (double a = 0.5; a < 360.0; a += 5.0) text += fmt::format("{},{:.4f},{:.4f}\n", a, Deviation_um(a, 1), Deviation_um(a, -1));
  Expect(Take(text), 100.0, 2000.0);
}

TEST_F(BallBar, MayShowItsLengthInPlaceOfTheDeviation) {
  const auto row = [](double a, int d) { return fmt::format("{} {:.7f} {}\n", a, 100.0 + Deviation_um(a, d) / 1000.0, d > 0 ? "+" : "-"); };
  Expect(Take("angle_deg radius_mm dir\n" + Circles(row)), 100.0, 1000.0);
  const auto named = [](double a, int d) { return fmt::format("{},{},{:.7f}\n", d > 0 ? "ccw" : "cw", a, 100.0 + Deviation_um(a, d) / 1000.0); };
  Expect(Take("dir,theta [deg],bar length [mm]\n" + Circles(named)), 100.0, 1000.0);
}

TEST_F(BallBar, TellsTheWayRoundByTheAngleWhereNothingElseDoes) {
  const Imported taken = Take("Radius: 100 mm\nTheta (deg)\tError (micron)\n" + Circles("{}\t{:.4f}\n"));
  Expect(taken, 100.0, 1000.0);
  EXPECT_THAT(taken.story, HasSubstr("counter-clockwise where it rises"));
}

TEST_F(BallBar, MayHaveArcsAtSeveralFeeds) {
  std::string text = "Radius: 100 mm\nfeed [mm/min],direction,angle [deg],deviation [um]\n";
  for (const int feed : {500, 2000})
    text += Circles([&](double a, int d) { return fmt::format("{},{},{},{:.4f}\n", feed, d, a, Deviation_um(a, d)); }, [](int) { return ""; }, 220);
  const Imported taken = TakeReadings(4 * 44, text);
  EXPECT_EQ(taken.readings.back().pass, 3);
  EXPECT_THAT(taken.set, testing::Contains("circular_procedure.feeds_mm_min=[500, 2000]"));
}

TEST_F(BallBar, IsToldWhatItsFileDoesNotSay) {
  const std::string text = "a,b\n" + Circles("{},{:.4f}\n");
  Expect(Take(text, "ball_bar", {"angle_deg=a", "deviation_um=b", "radius_inch=4", "feed_mm_min=800"}), 101.6, 800.0);
  EXPECT_THROW(Take(text, "ball_bar"), InputError) << "no column says what it is";
}

TEST_F(BallBar, LeavesAnEncoderBesideItsErrorAlone) {
  std::string text = "angle [deg],error [arcsec]\n";
  for (int k = 0; k < 72; ++k) text += fmt::format("{},{:.3f}\n", 5.0 * k, 10.0 * std::cos(5.0 * k * kDeg));
  EXPECT_EQ(Take(text).bench, "encoder_comparison");
}

/// Once round each way about (250, 120) mm, X 20 um/m too long: a line of run-in first.
std::string GridPlate(const std::string& header, double x_mm, double y_mm, const char* form) {
  std::string text = header + fmt::format(fmt::runtime(form), x_mm, y_mm, x_mm, y_mm);
  for (const int direction : {1, -1}) {
    for (int k = 0; k < 72; ++k) {
      const double angle_rad = direction * (5.0 * k + 1.0) * kDeg, x = 100.0 * std::cos(angle_rad), y = 100.0 * std::sin(angle_rad);
      text += fmt::format(fmt::runtime(form), x_mm + x, y_mm + y, x_mm + x * (1.0 + 20e-6), y_mm + y);
    }
  }
  return text;
}

TEST_F(Importing, TakesAGridPlateAboutTheCentreOfItsCommandedCircle) {
  const Imported taken = Take(GridPlate("Soll X [mm];Soll Y [mm];Ist X [mm];Ist Y [mm]\n", 250.0, 120.0, "{:.7f};{:.7f};{:.7f};{:.7f}\n"));
  EXPECT_THAT(taken.story, Says("taken as --map grid", "the feed is not stated: taken as 1000 mm/min"));
  ASSERT_EQ(taken.readings.size(), 144U) << taken.story;
  const Quantity x_m{"commanded_x_mm"}, y_m{"commanded_y_mm"}, grid_x_m{"grid_x_mm"};
  for (const Reading& r : taken.readings) {
    EXPECT_NEAR(std::hypot(x_m(r), y_m(r)) / units::mm, 100.0, 0.01);  // the middle of places every 5 deg
    EXPECT_NEAR((grid_x_m(r) - x_m(r)) / units::um, 20.0 * x_m(r), 1e-3 + 2.0 * 20e-6 * 100.0);
  }
  EXPECT_EQ(taken.readings.front().direction, 1);
  EXPECT_EQ(taken.readings.back().direction, -1);
  EXPECT_NE(taken.readings.front().pass, taken.readings.back().pass);
}

TEST_F(Importing, TakesPlacesOnACircleWithTimesForALogOfAController) {
  std::string text = "time [s],set x [mm],set y [mm],act x [mm],act y [mm]\n";
  for (int k = 0; k < 400; ++k)
    text += fmt::format("{:.2f},{:.6f},{:.6f},{:.6f},{:.6f}\n", 0.01 * k, 50.0 * std::cos(0.02 * k), 50.0 * std::sin(0.02 * k), 50.001 * std::cos(0.02 * k), 50.0 * std::sin(0.02 * k));
  EXPECT_THAT(Take(text).story, HasSubstr("taken as --map xy_log"));
}

TEST_F(Importing, SaysThatRestsOfALogAreLeftOut) {
  std::string text = "time [s],set x [mm],set y [mm],act x [mm],act y [mm]\n";
  for (int k = 0; k < 440; ++k) {
    const double a = 0.02 * std::clamp(k - 20, 0, 400);
    text += fmt::format("{:.2f},{:.6f},{:.6f},{:.6f},{:.6f}\n", 0.01 * k, 50.0 * std::cos(a), 50.0 * std::sin(a), 50.001 * std::cos(a), 50.0 * std::sin(a));
  }
  const std::string story = Take(text).story;
  EXPECT_THAT(story, HasSubstr("rows at rest, on the way to and from the circle"));
  EXPECT_THAT(story, Not(HasSubstr("without a time or a value")));
}

TEST(UnitsOverATime, AreUnitsInNamesAndInBrackets) {
  ASSERT_TRUE(UnitAtEnd("feed_mm_min"));
  EXPECT_EQ(UnitAtEnd("feed_mm_min")->name, "mm_min");
  EXPECT_NEAR(UnitAtEnd("feed_mm_min")->to_SI, 1e-3 / 60.0, 1e-18);
  EXPECT_NEAR(UnitAtEnd("velocity_deg_s")->to_SI, kDeg, 1e-15);
  EXPECT_NEAR(UnitNamed("m/min")->to_SI, 1.0 / 60.0, 1e-15);
  EXPECT_EQ(UnitAtEnd("time_s")->dimension, Dimension::kTime);
  EXPECT_FALSE(UnitNamed("mm/px"));
}

TEST_F(BallBar, NamesThePlaneAndRefusesSeveral) {
  const auto circles = [](const char* first, const char* second) {
    return "angle_deg,deviation_um,direction,plane\n" + Circles("{},{:.4f},{},{}\n", first, second);
  };
  EXPECT_THAT(Take(circles("Y-Z", "YZ")).story, HasSubstr("the circle is in the plane YZ: x of the results is Y, y is Z"));
  EXPECT_THAT(Take(circles("XY", "G17")).story, Not(HasSubstr("the plane")));
  EXPECT_THAT(MessageOf([&] { Take(circles("XY", "ZX")); }), HasSubstr("circles in the planes XY, ZX are in one file"));
  EXPECT_THAT(Take("Ebene: ZX\nangle_deg,deviation_um\n" + Circles("{},{:.4f}\n")).story, HasSubstr("x of the results is Z"));
}

/// A column of "G02" says the way round whatever it is called; lines of names and values above may be separated as the rows are.
TEST_F(BallBar, HasWaysRoundByTheirWordsAndConditionsBetweenCommas) {
  const Imported taken = Take("Serial,12345\nDate,2024-05-06 10:11\nBallbar length,100,mm\nFeed rate,500,mm/min\nCode,Angle,Deviation\n,deg,uin\n" +
                              Circles([](double a, int d) { return fmt::format("{},{},{:.3f}\n", d > 0 ? "G03" : "G02", a, Deviation_um(a, d) / 0.0254); }));
  Expect(taken, 100.0, 500.0);
  EXPECT_THAT(taken.story, Not(HasSubstr("not said")));
}

/// What two axes of a circle say without units is compared as angles, and that it may be something else is said.
TEST_F(BallBar, LogsWithoutUnitsAreNamed) {
  std::string text = "time_s\tcommandedPosX\tcommandedPosY\tactualPosX\tactualPosY\n";
  for (int k = 0; k < 720; ++k)
    text += fmt::format("{:.2f}\t{:.4f}\t{:.4f}\t{:.4f}\t{:.4f}\n", 0.01 * k, 50.0 * std::cos(0.02 * k), 50.0 * std::sin(0.02 * k),
                        50.0 * std::cos(0.02 * (k - 1)), 50.0 * std::sin(0.02 * (k - 1)));
  EXPECT_THAT(Take(text).story, HasSubstr("by its names it may be of another kind; of a log of a controller on a circle"));
  EXPECT_EQ(Take(text, "xy_log").bench, "circular_motion");
}

TEST_F(BallBar, MayBeFrench) {
  Expect(Take("Rayon (mm);100\nAvance (mm/min);500\nAngle (°);Écart (µm);Sens\n" + Circles("{0};{1:.4f};{3}\n", "antihoraire", "horaire")), 100.0, 500.0);
}

/// Each run an object of lists, and what holds for all beside them.
TEST_F(BallBar, MayBeRunsInJSON) {
  std::string runs;
  for (const int direction : {1, -1}) {
    std::string angles, values;
    for (int k = 0; k < 360; k += 5) {
      const double angle_deg = direction > 0 ? k + 0.5 : 359.5 - k;
      angles += fmt::format("{}{}", k > 0 ? "," : "", angle_deg);
      values += fmt::format("{}{:.4f}", k > 0 ? "," : "", Deviation_um(angle_deg, direction));
    }
    runs += fmt::format(R"({}{{"direction":"{}","angle_deg":[{}],"deviation_um":[{}]}})", direction > 0 ? "" : ",", direction > 0 ? "ccw" : "cw", angles, values);
  }
  Expect(Take(R"({"radius_mm":100,"feed_mm_min":500,"runs":[)" + runs + "]}"), 100.0, 500.0);
}

// What software of ball bars exports: tags, then the values of each run, one a line.

double Bar_um(double angle_deg) { return 4.0 * std::sin(2.0 * angle_deg * kDeg) + 0.01 * angle_deg; }

/// @param from_deg, to_deg  Of the values, both of them there.
std::string BarValues(double from_deg, double to_deg, int count, const char* form = "{:.4f}\n",
                      double factor = 1.0) {
  std::string text;
  for (int k = 0; k < count; ++k) {
    const double at_deg = from_deg + (to_deg - from_deg) * k / (count - 1);
    text += fmt::format(fmt::runtime(form), factor * Bar_um(std::remainder(at_deg - 180.0, 360.0) + 180.0));
  }
  return text;
}

class BarExport : public Importing {
 protected:
  static void Expect(const Imported& taken, double radius_mm, double feed_mm_min, std::size_t readings) {
    ExpectCircles(taken, radius_mm, feed_mm_min, readings, [](double angle_deg, int) { return Bar_um(angle_deg); }, 3.6);
  }
};

TEST_F(BarExport, IsReadRunByRun) {
  const Imported taken = Take(
      "BALLBAR RESULTS\nOperator: 7\nRadius: 100 mm\nFeedrate: 500 mm/min\nStart angle: 0\nEnd angle: 360\nUnits: "
      "microns\n\nRun 1 CCW\n" +
      BarValues(0.0, 360.0, 361) + "Run 2 CW\n" + BarValues(360.0, 0.0, 361));
  Expect(taken, 100.0, 500.0, 722);
  EXPECT_EQ(taken.readings.front().direction, 1);
  EXPECT_EQ(taken.readings.back().direction, -1);
  EXPECT_THAT(taken.story, HasSubstr("taken as --map ball_bar"));
  EXPECT_THAT(taken.story, Not(HasSubstr("no tag says the unit")));
}

TEST_F(BarExport, MayHaveElementsMillimetresAndCommas) {
  const Imported taken = Take(
      "<Test>\n<TestRadius>150,0</TestRadius>\n<FeedRate>2000</FeedRate>\n<Unit>mm</Unit>\n<Unknown>12</"
      "Unknown>\n<Direction>clockwise</Direction>\n<Data>\n" +
      [] {
        std::string text = BarValues(359.5, 0.0, 720, "<v>{:.7f}</v>\n", 1e-3);
        std::ranges::replace(text, '.', ',');
        return text;
      }() +
      "</Data>\n</Test>\n");
  Expect(taken, 150.0, 2000.0, 720);
  EXPECT_EQ(taken.readings.front().direction, -1);
}

/// 220 deg between 20 and 240 deg, of which 45 deg at either end are overshoot: 100 values a second at 6000 mm/min
/// on 100 mm.
TEST_F(BarExport, LeavesOvershootOutWhereTheSamplingSaysThatItIsThere) {
  const double step_deg = 1.0 / 100.0 / kDeg;  // 1 mm a value
  const int count = static_cast<int>(std::lround(310.0 / step_deg)) + 1;
  const std::string tags =
      "radius = 100\nfeed rate = 6000\nstart angle = 20\nend angle = 240\novershoot = 45\ndirection = ccw\n";
  const Imported taken = Take(tags + "sample rate = 100\n" + BarValues(-25.0, 285.0, count));
  EXPECT_EQ(taken.readings.size(),
            static_cast<std::size_t>(count) - 2U * static_cast<std::size_t>(std::lround(45.0 / 310.0 * count)))
      << taken.story;
  const Quantity x_m{"commanded_x_mm"}, y_m{"commanded_y_mm"}, bar_m{"bar_um"};
  for (const Reading& r : taken.readings) {
    const double angle_deg = std::atan2(y_m(r), x_m(r)) / kDeg;
    ASSERT_NEAR(bar_m(r) / units::um, Bar_um(angle_deg < 0.0 ? angle_deg + 360.0 : angle_deg), 0.05)
        << "half a step at 8 um/rad";
  }
  Expect(Take(tags + BarValues(20.0, 240.0, 221)), 100.0, 6000.0, 221);
}

TEST_F(BarExport, MayHaveAFeedForEachRun) {
  std::string text = "test radius: 100\nunits: um\n";
  for (const int feed : {500, 2000})
    for (const bool ccw : {true, false})
      text += fmt::format("feed: {}\n{}\n", feed, ccw ? "ccw" : "cw") +
              (ccw ? BarValues(0.0, 359.0, 360) : BarValues(359.0, 0.0, 360));
  const Imported taken = TakeReadings(4 * 360, text);
  EXPECT_EQ(taken.readings.back().pass, 3);
  EXPECT_THAT(taken.set, testing::Contains("circular_procedure.feeds_mm_min=[500, 2000]"));
}

TEST_F(BarExport, LeavesTablesAlone) {
  std::string text = "Radius: 150\nFeed: 1000\nDirection: CCW\nangle [deg],deviation [um]\n";
  for (int k = 0; k < 72; ++k) text += fmt::format("{},{}\n", 5 * k, k % 7);
  const Imported taken = TakeReadings(72, text);
  EXPECT_THAT(taken.story, Not(HasSubstr("tags and runs")));
}

}  // namespace
}  // namespace twinbench::imports
