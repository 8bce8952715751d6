#include "tests/import/importing.h"

// Tables of poses as R-tests and probes write them: other names, units and orders of the same readings.
namespace twinbench::imports {
namespace {

using testing::Contains, testing::HasSubstr;

struct Pose {
  int ball;
  double x_mm, y_mm, z_mm, a_deg, c_deg, dx_um, dy_um, dz_um;
};

std::vector<Pose> Poses() {
  std::vector<Pose> poses;
  for (int k = 0; k < 24; ++k) {
    const double c_deg = 30.0 * (k % 12), a_deg = k < 12 ? 0.0 : -45.0, c = c_deg * units::deg;
    poses.push_back({1 + k / 12, 100.0 * std::cos(c), 100.0 * std::sin(c), 0.5 * k, a_deg, c_deg, 5.0 + k,
                     -3.0 + 0.5 * k, 0.25 * k});
  }
  return poses;
}

std::string Table(const std::string& header, const std::function<std::string(const Pose&)>& row) {
  std::string text = header;
  for (const Pose& pose : Poses()) text += row(pose);
  return text;
}

class PoseTable : public Importing {
 protected:
  static void Expect(const Imported& taken, bool balls = true) {
    EXPECT_THAT(taken.story, HasSubstr("taken as --map pose_table"));
    EXPECT_THAT(taken.set, Contains("freeform_procedure.instrument=displacement"));
    const std::vector<Pose> poses = Poses();
    ASSERT_EQ(taken.readings.size(), poses.size()) << taken.story;
    const auto value = [&taken](std::size_t i, const char* column) { return Quantity{column}(taken.readings[i]); };
    for (std::size_t i = 0; i < poses.size(); ++i) {
      EXPECT_NEAR(value(i, "x_mm") / units::mm, poses[i].x_mm, 1e-6);
      EXPECT_NEAR(value(i, "z_mm") / units::mm, poses[i].z_mm, 1e-6);
      EXPECT_NEAR(value(i, "a_deg") / units::deg, poses[i].a_deg, 1e-6);
      EXPECT_NEAR(value(i, "c_deg") / units::deg, poses[i].c_deg, 1e-6);
      EXPECT_NEAR(value(i, "dx_um") / units::um, poses[i].dx_um, 1e-3);
      EXPECT_NEAR(value(i, "dy_um") / units::um, poses[i].dy_um, 1e-3);
      EXPECT_NEAR(value(i, "dz_um") / units::um, poses[i].dz_um, 1e-3);
      EXPECT_EQ(taken.readings[i].setup, balls ? poses[i].ball : 0);
    }
  }
};

TEST_F(PoseTable, IsGuessedByARotaryAxisAndDisplacements) {
  Expect(Take(Table("Ball,X [mm],Y [mm],Z [mm],A [deg],C [deg],dX [um],dY [um],dZ [um]\n", [](const Pose& p) {
    return fmt::format("{},{},{},{},{},{},{},{},{}\n", p.ball, p.x_mm, p.y_mm, p.z_mm, p.a_deg, p.c_deg, p.dx_um,
                       p.dy_um, p.dz_um);
  })));
}

TEST_F(PoseTable, MayBeGermanInAnotherOrderAndOtherUnits) {
  std::string text = Table(
      "R-Test\nAbweichung Z [mm];Winkel C [rad];Achse X (m);Abweichung X [mm];Winkel A [rad];Achse Z "
      "(m);Kugel;Abweichung Y [mm];Achse Y (m)\n",
      [](const Pose& p) {
        return fmt::format("{:.7f};{:.9f};{:.9f};{:.7f};{:.9f};{:.9f};{};{:.7f};{:.9f}\n", p.dz_um / 1e3,
                           p.c_deg * units::deg, p.x_mm / 1e3, p.dx_um / 1e3, p.a_deg * units::deg, p.z_mm / 1e3,
                           p.ball, p.dy_um / 1e3, p.y_mm / 1e3);
      });
  std::ranges::replace(text, '.', ',');
  Expect(Take(text));
}

/// Errors of angles and lengths are a ball bar's where nothing else is there.
TEST_F(PoseTable, IsNoBallBarThoughItHasAnglesAndErrors) {
  Expect(Take(Table("A angle (deg)\tC angle (deg)\terror x (micron)\terror y (micron)\terror z (micron)\tx (mm)\ty "
                    "(mm)\tz (mm)\n",
                    [](const Pose& p) {
                      return fmt::format("{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\n", p.a_deg, p.c_deg, p.dx_um, p.dy_um,
                                         p.dz_um, p.x_mm, p.y_mm, p.z_mm);
                    })),
         false);
}

TEST_F(PoseTable, MayHaveWhereAProbeMeasuredTheBall) {
  Expect(
      Take(Table("sphere,X nominal [mm],X measured [mm],Y nominal [mm],Y measured [mm],Z nominal [mm],Z measured "
                 "[mm],A [deg],C [deg]\n",
                 [](const Pose& p) {
                   return fmt::format("{},{:.8f},{:.8f},{:.8f},{:.8f},{:.8f},{:.8f},{},{}\n", p.ball, p.x_mm,
                                      p.x_mm + p.dx_um / 1e3, p.y_mm, p.y_mm + p.dy_um / 1e3, p.z_mm,
                                      p.z_mm + p.dz_um / 1e3, p.a_deg, p.c_deg);
                 })));
}

/// Nominal and measured X, Y, Z beside a rotary axis are nothing else, though no unit is said.
TEST_F(PoseTable, OfNominalAndMeasuredPlacesNeedsNoUnits) {
  const Imported taken =
      Take(Table("touch probe on a sphere\nsphere,nominal X,nominal Y,nominal Z,A,C,measured X,measured Y,measured Z\n", [](const Pose& p) {
        return fmt::format("{},{:.6f},{:.6f},{:.6f},{},{},{:.8f},{:.8f},{:.8f}\n", p.ball, p.x_mm, p.y_mm, p.z_mm, p.a_deg, p.c_deg,
                           p.x_mm + p.dx_um / 1e3, p.y_mm + p.dy_um / 1e3, p.z_mm + p.dz_um / 1e3);
      }));
  Expect(taken);
  EXPECT_THAT(taken.story, HasSubstr("the unit of \"measured X\" is not said and taken as mm"));
}

TEST_F(PoseTable, SaysThatItsBallIsNowhere) {
  const Imported taken = Take(Table("C [deg],dX [um],dY [um]\n", [](const Pose& p) {
    return fmt::format("{},{},{}\n", p.c_deg, p.dx_um, p.dy_um);
  }));
  EXPECT_THAT(taken.story, HasSubstr("x is not in the file"));
  EXPECT_TRUE(std::isnan(Quantity{"dz_um"}(taken.readings[0])));
}

// The shipped samples, to what the programs beside them hid.

nlohmann::json ErrorsOfSample(const std::string& file) {
  const Imported taken = Import({std::string(TWINBENCH_SOURCE_DIR) + "/scenarios/samples/" + file}, LoadMap(""));
  return Evaluated(taken).results.at("errors");
}

/// Within four standard uncertainties, of which the largest is told.
void ExpectHidden(const nlohmann::json& errors, const std::string& key, double value, double largest_u) {
  ASSERT_TRUE(errors.contains(key)) << key;
  const double u = errors.at(key).at("u");
  EXPECT_NEAR(errors.at(key).at("value").get<double>(), value, 4.0 * u) << key;
  EXPECT_LT(u, largest_u) << key;
}

TEST(Samples, OfAPoseTableHaveItsLocations) {
  const nlohmann::json errors = ErrorsOfSample("pose_table.csv");
  for (const auto& [key, value] : {std::pair{"XOC", 12.0}, {"YOC", -7.0}, {"AOC", 9.0}, {"BOC", -3.0}, {"YOA", 8.0},
                                   {"ZOA", -5.0}, {"BOA", 4.0}, {"COA", -6.0}, {"COY", 5.0}, {"BOZ", -4.0},
                                   {"AOZ", 3.0}})
    ExpectHidden(errors, key, value, 0.3);
}

TEST(Samples, OfABarsExportHaveItsErrors) {
  const nlohmann::json errors = ErrorsOfSample("ball_bar.b5r");
  ExpectHidden(errors, "machine.squareness_arcsec", 6.19, 0.1);
  ExpectHidden(errors, "machine.scale_mismatch_um_m", 30.0, 0.5);
  ExpectHidden(errors, "machine.backlash_y_um", 5.0, 0.1);
  ExpectHidden(errors, "machine.backlash_x_um", 0.0, 0.1);
}

/// What the orders leave of a table that goes round once may be more orders as well as noise.
TEST_F(Importing, SaysNothingRepeatsWhereNoPlaceWasReadTwice) {
  const auto summary = [this](bool back) {
    std::string text = "reference [deg],measured [deg]\n";
    const auto add = [&text](int i) { text += fmt::format("{},{:.4f}\n", 2 * i, 2 * i + 0.1 * std::sin(2.0 * i * units::deg) + 0.01 * std::cos(160.0 * i * units::deg)); };
    for (int i = 0; i <= 180; ++i) add(i);
    for (int i = 180; back && i >= 0; --i) add(i);
    const Imported taken = Take(text);
    return EvaluationOf(ParseScenario("bench = \"" + taken.bench + "\"\n", "table", "", taken.set), taken.readings, Estimator::kRigorous).summary;
  };
  EXPECT_THAT(summary(false), testing::AllOf(testing::HasSubstr("left about the orders"), testing::HasSubstr("for no place was read twice"), testing::Not(testing::HasSubstr("repeats to"))));
  EXPECT_THAT(summary(true), testing::HasSubstr("a reading repeats to"));
}

}  // namespace
}  // namespace twinbench::imports
