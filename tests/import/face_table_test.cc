#include "tests/import/importing.h"
#include "twin/benches/registry.h"
#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/core/stream.h"
#include "twin/separate/index_errors.h"

// Tables of a certified polygon under an autocollimator: other names, orders, units and ways of saying the direction.
namespace twinbench::imports {
namespace {

using testing::Contains, testing::HasSubstr, testing::Not;

double Certified_arcsec(int face) { return 1.5 * std::sin(2.3 * face); }
double Table_arcsec(double angle_deg, int direction) {
  return 3.0 * std::sin(angle_deg * units::deg) + (direction < 0 ? 0.2 : 0.0);
}

using FaceRow = std::function<std::string(int face, double angle_deg, double forward_arcsec, double reverse_arcsec)>;

std::string Faces(int faces, const FaceRow& row) {
  std::string text;
  for (int k = 0; k < faces; ++k) {
    const double angle_deg = 360.0 * k / faces, certified_arcsec = Certified_arcsec(k);
    text += row(k + 1, angle_deg, Table_arcsec(angle_deg, 1) + certified_arcsec, Table_arcsec(angle_deg, -1) + certified_arcsec);
  }
  return text;
}
/// @param form  Of 0 the face, 1 its angle in deg, 2 forward, 3 reverse, 4 certified, in arcsec.
std::string Faces(int faces, const std::string& form) {
  return Faces(faces, [&](int face, double angle, double forward, double reverse) {
    return fmt::format(fmt::runtime(form), face, angle, forward, reverse, Certified_arcsec(face - 1));
  });
}
const std::string kBothWays = "{1:g},{2:.4f},{3:.4f},{4:.4f}\n";

class FaceTable : public Importing {
 protected:
  /// Each reading is the table's error at its face, and each way round a pass.
  static void Expect(const Imported& taken, int faces) {
    EXPECT_EQ(taken.bench, "turntable_autocollimator");
    EXPECT_THAT(taken.set, Contains(fmt::format("turntable_procedure.positions={}", faces)));
    ASSERT_EQ(taken.readings.size(), 2U * static_cast<std::size_t>(faces)) << taken.story;
    for (const Reading& r : taken.readings) {
      EXPECT_NEAR(r.autocollimator_yaw_rad / units::arcsec, Table_arcsec(r.target_rad / units::deg, r.direction), 2e-3);
      EXPECT_TRUE(std::isnan(r.autocollimator_tilt_rad));
    }
    EXPECT_EQ(taken.readings.front().direction, 1);
    EXPECT_EQ(taken.readings.back().direction, -1);
    EXPECT_LT(taken.readings.back().target_rad, 1e-9) << "the way back ends where the way there began";
    EXPECT_NE(taken.readings.front().pass, taken.readings.back().pass);
  }
};

TEST_F(FaceTable, IsGuessedByItsCertifiedDeviations) {
  const Imported taken = Take("face,nominal_deg,certified_dev_arcsec,reading_forward_arcsec,reading_reverse_arcsec\n" +
                              Faces(12, "{0},{1:g},{4:.4f},{2:.4f},{3:.4f}\n"));
  Expect(taken, 12);
  EXPECT_THAT(taken.story, HasSubstr("taken as --map face_table"));
  EXPECT_THAT(taken.story, Not(HasSubstr("no certified deviations")));
  // The second axis of the autocollimator was not read, and a compensation needs none.
  const Scenario scenario = Made(taken);
  EXPECT_EQ(BenchOf(scenario).index_errors(scenario, taken.readings).Count(), 12);
}

TEST_F(FaceTable, MayBeGermanInRadAndSayTheDirectionInAColumn) {
  std::string there, back;
  Faces(24, [&](int face, double angle, double forward, double reverse) {
    const auto row = [&](const char* way, double shown) {
      std::string text = fmt::format("{};{:.6f};{:.9f};{:.9f}\n", way, angle, shown * units::arcsec * 1e6, Certified_arcsec(face - 1) * units::arcsec * 1e6);
      std::ranges::replace(text, '.', ',');
      return text;
    };
    there += row("vorwärts", forward);
    back = row("rückwärts", reverse) + back;
    return "";
  });
  Expect(Take("Richtung;Winkel [°];Ablesung [µrad];Kalibrierschein [µrad]\n" + there + back), 24);
}

TEST_F(FaceTable, WithoutCertifiedDeviationsSaysSo) {
  const Imported taken = Take("nominal [deg],autocollimator [arcsec]\n" + Faces(36, "{1:g},{2:.4f}\n"), "face_table");
  EXPECT_EQ(taken.readings.size(), 36U);
  EXPECT_THAT(taken.story, HasSubstr("no certified deviations were found"));
}

/// Columns that are called by the way round alone, a certificate's expanded uncertainty, and a face's number beside them.
TEST_F(FaceTable, MayCallItsColumnsByTheWayRoundAlone) {
  const std::string rows = Faces(8, "{},{:g},{:.4f},{:.4f},{:.4f},0.1\n");
  const Imported taken = Take("Face,Nominal [°],Forward [\"],Reverse [\"],Certified [\"],U (k=2) [\"]\n" + rows);
  Expect(taken, 8);
  EXPECT_THAT(taken.set, Contains("multitooth.u_tooth_arcsec=0.05"));
  Expect(Take("No.,Soll [°],Run 1 fwd (\"),Run 1 rev (\"),Kalibrierwert (\"),u (\")\n" + rows), 8);
}

/// "rück" beside "vor" is the way back; what nothing is made of is said.
TEST_F(FaceTable, MayAbbreviateTheWayBackAndSaysWhatItLeaves) {
  const std::string rows = Faces(12, "{1:g};{2:.4f};{3:.4f};{4:.4f}\n");
  for (const char* names : {"Sollwinkel [°];Ablesung vor [″];Ablesung rück [″];Kalibrierwert [″]\n", "angolo [°];lettura andata [\"];lettura ritorno [\"];certificato [\"]\n",
                            "angle [deg];reading fwd [arcsec];reading back [arcsec];certified [arcsec]\n"}) {
    const Imported taken = Take(names + rows);
    Expect(taken, 12);
    EXPECT_THAT(taken.story, Not(HasSubstr("left out"))) << names;
  }
  EXPECT_THAT(Take("Sollwinkel [°];Ablesung [″];Nullkontrolle [″];Kalibrierwert [″]\n" + rows).story, HasSubstr("left out, for by its name nothing of this map is meant: \"Nullkontrolle\""));
}

/// Old instruments are read in seconds and mean those of arc.
TEST_F(FaceTable, MayBeInSecondsOfArc) {
  const Imported taken = Take("Angle,Reading forward (sec),Reading reverse (sec),Certified (sec)\n" + Faces(12, kBothWays));
  Expect(taken, 12);
  EXPECT_THAT(taken.story, HasSubstr("\"Certified\" is no time: its \"sec\" is taken as arcsec"));
  std::string logged = "time (sec),target (deg),error (sec),dwell (sec)\n";
  for (int k = 0; k < 40; ++k) logged += fmt::format("{},{},{:.3f},0.5\n", k, 9 * k, 1.0 + 0.01 * k);
  const Imported clocked = Take(logged);
  EXPECT_THAT(clocked.story, HasSubstr("clock: time [s]"));
  EXPECT_THAT(clocked.story, Not(HasSubstr("dwell\" is no time")));
  EXPECT_NEAR((clocked.readings.back().measured_rad - clocked.readings.back().reference_rad) / units::arcsec, 1.39, 1e-6);
}

/// Of both axes, in columns of their own for each way: y is no second reading of x, and a certificate may say nothing but zeros.
TEST_F(FaceTable, TakesTheSecondAxis) {
  std::string sides = "angle [deg],x forward [arcsec],Y forward [arcsec],x reverse [arcsec],Y reverse [arcsec],certified [arcsec]\n", plain = "angle [deg],x [arcsec],y [arcsec],certified [arcsec]\n";
  for (int k = 0; k < 12; ++k) {
    const double angle_deg = 30.0 * k, y_arcsec = 600.0 * std::cos(angle_deg * units::deg);
    sides += fmt::format("{:g},{:.4f},{:.4f},{:.4f},{:.4f},0.00\n", angle_deg, Table_arcsec(angle_deg, 1), y_arcsec, Table_arcsec(angle_deg, -1), y_arcsec);
    plain += fmt::format("{:g},{:.4f},{:.4f},0.00\n", angle_deg, Table_arcsec(angle_deg, 1), y_arcsec);
  }
  for (const auto& [text, readings] : {std::pair{sides, 24U}, std::pair{plain, 12U}}) {
    const Imported taken = Take(text);
    EXPECT_EQ(taken.bench, "turntable_autocollimator");
    EXPECT_THAT(taken.story, Not(HasSubstr("no certified deviations")));
    ASSERT_EQ(taken.readings.size(), readings) << taken.story;
    for (const Reading& r : taken.readings) {
      EXPECT_NEAR(r.autocollimator_yaw_rad / units::arcsec, Table_arcsec(r.target_rad / units::deg, r.direction), 2e-3);
      EXPECT_NEAR(r.autocollimator_tilt_rad / units::arcsec, 600.0 * std::cos(r.target_rad), 2e-3);
    }
    EXPECT_THAT(taken.set, Contains("autocollimator.range_arcsec=1200")) << "of y, beyond the usual one";
  }
}

/// Each run has a column, "up" and "down" say the way, and two apostrophes are seconds.
TEST_F(FaceTable, MayHaveAColumnForEachRun) {
  Expect(Take("angle (deg),reading up (''),reading down (''),certified ('')\n" + Faces(12, kBothWays)), 12);
  const Imported taken = Take("nominal_deg,run1_arcsec,run2_arcsec,certified_arcsec\n" + Faces(12, kBothWays));
  ASSERT_EQ(taken.readings.size(), 24U) << taken.story;
  EXPECT_NE(taken.readings.front().pass, taken.readings.back().pass);
}

/// The certificate has angles of the faces, or corrections; or only the faces are numbered.
TEST_F(FaceTable, TakesCertificatesOfOtherKinds) {
  const auto both = [](const std::string& names, const std::function<std::string(int, double)>& certified) {
    std::string back, there = Faces(12, [&](int face, double angle, double forward, double reverse) {
      back = fmt::format("-,{},{:g},{:.4f},{}\n", face, angle, reverse, certified(face - 1, angle)) + back;
      return fmt::format("+,{},{:g},{:.4f},{}\n", face, angle, forward, certified(face - 1, angle));
    });
    return "direction," + names + "\n" + there + back;
  };
  Expect(Take(both("no,nominal angle (deg),reading (arcsec),certified angle (deg)",
                   [](int face, double angle) { return fmt::format("{:.8f}", angle + Certified_arcsec(face) / 3600.0); })),
         12);
  const auto correction = [](int face, double) { return fmt::format("{:.4f}", -Certified_arcsec(face)); };
  Expect(Take(both("no,position (deg),reading (arcsec),correction (arcsec)", correction)), 12);
  const Imported numbered = Take(both("face,remark,reading (arcsec),certified deviation (arcsec)",
                                      [](int face, double) { return fmt::format("{:.4f}", Certified_arcsec(face)); }));
  Expect(numbered, 12);
  EXPECT_THAT(numbered.story, HasSubstr("stand evenly round the circle"));
  Expect(Take(both("face,remark,autocollimator x [arcsec],correction [arcsec]", correction)), 12);
  Expect(Take(both("Fläche,Nr,Ablesung [\"],Korrektur [\"]", correction)), 12);
}

/// An error beside an angle is that of a device; what an autocollimator read at nominal angles is a face table.
TEST_F(FaceTable, OfReadingsAloneIsGuessedWhereTheyAreNoErrors) {
  const std::string rows = Faces(36, "{1:g},{2:.4f}\n");
  EXPECT_EQ(Take("angle_deg,x_arcsec\n" + rows).bench, "turntable_autocollimator");
  EXPECT_EQ(Take("angle_deg,measured error [arcsec]\n" + rows).bench, "encoder_comparison");
}

/// Nothing is left over, and nothing is invented.
TEST_F(FaceTable, ReadOnceHasErrorsWithoutAnUncertainty) {
  const Imported taken = Take("nominal [deg],reading [arcsec],certified [arcsec]\n" + Faces(8, "{1:g},{2:.4f},{4:.4f}\n"));
  const report::Evaluation evaluated = Evaluated(taken);
  EXPECT_EQ(evaluated.not_separated, "");
  EXPECT_THAT(evaluated.summary, HasSubstr("no position was read twice"));
  const auto& turntable = evaluated.results.at("separation").at("turntable");
  EXPECT_FALSE(turntable.contains("u_ez_arcsec"));
  EXPECT_NEAR(turntable.at("ez_arcsec").at(2).get<double>(), 3.0, 0.01);
}

/// 24 places up and down so often, of a certificate of zeros.
std::string Repeats(int runs, const std::function<double(double angle_deg, int way, int run)>& shown_arcsec) {
  std::string text = "position (deg),reading (arcsec),certified (arcsec),direction,run\n";
  for (int row = 0; row < 48 * runs; ++row) {
    const int run = row / 48 + 1, way = row % 48 < 24 ? 1 : -1;
    const double angle_deg = 15.0 * (way > 0 ? row % 24 : 23 - row % 24);
    text += fmt::format("{:g},{:.2f},0.00,{},{}\n", angle_deg, shown_arcsec(angle_deg, way, run), way > 0 ? "up" : "down", run);
  }
  return text;
}

/// The noise that the made scenario states is that of its repeats, which one disturbed reading does not widen; without any nothing is known.
TEST_F(FaceTable, StatesTheNoiseOfItsRepeats) {
  for (const int runs : {1, 4}) {
    Stream noise(5, "autocollimator.noise");
    const Imported taken = Take(Repeats(runs, [&](double angle_deg, int way, int run) {
      return Table_arcsec(angle_deg, way) + 0.5 * noise.Normal() + (run == 2 && way > 0 && angle_deg == 105.0 ? 40.0 : 0.0);
    }));
    const double stated_arcsec = TurntableOf(Made(taken)).autocollimator.noise_rad / units::arcsec;
    EXPECT_NEAR(stated_arcsec, runs > 1 ? 0.5 : 0.02, runs > 1 ? 0.08 : 1e-9);
    EXPECT_EQ(taken.story.find("the noise of the autocollimator is not known") != std::string::npos, runs == 1) << taken.story;
  }
}

/// Somebody leant on the stone: of four readings of a place one is far off. Readings in steps of an arcsec that differ by one are not.
TEST_F(FaceTable, LeavesASingleDisturbedReadingOut) {
  for (const bool is_coarse : {false, true}) {
    Stream noise(3, "autocollimator.noise");
    const Imported taken = Take(Repeats(2, [&](double angle_deg, int way, int run) {
      const double disturbed = !is_coarse && run == 2 && way > 0 && angle_deg == 270.0 ? 20.0 : 0.0;
      const double shown = 30.0 * std::sin(angle_deg * units::deg) + (is_coarse ? 0.3 : 0.05) * noise.Normal() + disturbed;
      return is_coarse ? std::round(shown) : shown;
    }));
    const report::Evaluation evaluated = Evaluated(taken);
    EXPECT_EQ(evaluated.summary.find("reading 66 is left out of the errors") != std::string::npos, !is_coarse) << evaluated.summary;
    const auto& turntable = evaluated.results.at("separation").at("turntable");
    for (std::size_t k = 0; k < 24; ++k) {
      const double u_arcsec = turntable.at("u_ez_arcsec").at(k).get<double>();
      EXPECT_LT(u_arcsec, is_coarse ? 0.6 : 0.15);
      EXPECT_NEAR(turntable.at("ez_arcsec").at(k).get<double>(), 30.0 * std::sin(15.0 * static_cast<double>(k) * units::deg), is_coarse ? 0.6 : 0.15);
    }
  }
}

}  // namespace
}  // namespace twinbench::imports
