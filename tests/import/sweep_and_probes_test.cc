#include "tests/import/importing.h"
#include "twin/core/stream.h"

// An autocollimator against a known angle, and displacements and tilts of a spindle: other names, orders, units and separators than the samples'.
namespace twinbench::imports {
namespace {

using testing::HasSubstr, testing::Not;

class AutocollimatorSweep : public Importing {
 protected:
  static void Expect(const Imported& taken, std::size_t readings, double slope) {
    ASSERT_EQ(taken.bench, "turntable_autocollimator") << taken.story;
    ASSERT_EQ(taken.readings.size(), readings) << taken.story;
    for (const Reading& r : taken.readings) {
      EXPECT_EQ(r.phase, Phase::kCalibration);
      EXPECT_NEAR(r.autocollimator_yaw_rad / units::arcsec, slope * r.target_rad / units::arcsec + 1.0, 2e-3);
    }
  }
};

TEST_F(AutocollimatorSweep, IsGuessedByItsNames) {
  std::string text = "Sollwinkel [µrad];Autokollimator [µrad]\n";
  for (int k = 0; k < 41; ++k) text += fmt::format("{};{:.4f}\n", 10 * k - 200, (1.01 * (10 * k - 200)) + 4.848137);
  const Imported taken = Take(text);
  Expect(taken, 41, 1.01);
  EXPECT_THAT(taken.story, HasSubstr("taken as --map autocollimator_sweep"));
  EXPECT_EQ(taken.readings.front().direction, 1);
}

TEST_F(AutocollimatorSweep, GoesThereAndBackInMinutesOfArc) {
  std::string text = "# sine bar, one sweep up and one down\nrun\tx (arcsec)\ty (arcsec)\ttilt (arcmin)\n";
  for (int k = 0; k < 42; ++k) {
    const double angle_arcmin = 0.5 * (k < 21 ? k : 41 - k);
    text += fmt::format("{}\t{:.4f}\t{:.4f}\t{}\n", k < 21 ? 1 : 2, 1.0 - 60.0 * angle_arcmin, 0.2, angle_arcmin);
  }
  const Imported taken = Take(text);
  Expect(taken, 42, -1.0);
  EXPECT_EQ(taken.readings.back().direction, -1);
  EXPECT_EQ(taken.readings.back().position, taken.readings.front().position);
  EXPECT_NE(taken.readings.back().pass, taken.readings.front().pass);
  EXPECT_NEAR(taken.readings.back().autocollimator_tilt_rad / units::arcsec, 0.2, 1e-6);
  EXPECT_THAT(taken.set, testing::Contains(HasSubstr("autocollimator.range_arcsec=8"))) << "beyond the usual one";
}

TEST_F(AutocollimatorSweep, MayBeThatOfYInAnySense) {
  std::string text = "SAG (arcsec),x (arcsec),y (arcsec)\n";
  for (int k = 0; k < 41; ++k) text += fmt::format("{},{:.3f},{:.4f}\n", 10 * k - 200, 0.02 * (k % 3), -1.01 * (10 * k - 200));
  const Imported taken = Take(text);
  ASSERT_EQ(taken.bench, "turntable_autocollimator") << taken.story;
  EXPECT_EQ(taken.readings.front().phase, Phase::kCalibration);
  EXPECT_NEAR(taken.readings.front().autocollimator_tilt_rad / units::arcsec, 202.0, 1e-6);
}

/// Whoever made it turned the instrument as he liked: no cause is the other sense.
TEST_F(AutocollimatorSweep, IsDiagnosedInTheSenseThatItHas) {
  for (const double sense : {1.0, -1.0}) {
    Stream noise(5, "autocollimator.noise");
    std::string text = "reference (arcsec),y (arcsec)\n";
    for (int k = 0; k < 81; ++k) {
      const double angle_arcsec = 5.0 * k - 200.0;
      text += fmt::format("{},{:.4f}\n", angle_arcsec, sense * (angle_arcsec + 0.3 * std::cos(units::turn * angle_arcsec / 40.0) + 0.02 * noise.Normal()));
    }
    const Imported taken = Take(text);
    const diagnose::Diagnosis found = Diagnosed(taken);
    ASSERT_FALSE(found.causes.empty()) << sense;
    EXPECT_EQ(found.causes[0].effect, "autocollimator_periodic") << sense;
    EXPECT_EQ(std::ranges::count_if(found.notes, [](const std::string& note) { return note.find("counts against") != std::string::npos; }), sense < 0.0 ? 1 : 0);
  }
}

/// At even steps of 2 arcsec a period of 23.7 looks like one of 2.18, and what is shown has the ripple itself in it.
TEST_F(AutocollimatorSweep, HasTheLongestOfThePeriodsThatLookAlike) {
  for (const auto& [scale, period_arcsec] : {std::pair{-0.985, 23.7}, std::pair{1.0, 23.7}, std::pair{1.0, 150.0}, std::pair{1.002, 1.0 / (1.0 / 1.7 - 0.5)}}) {
    Stream noise(7, "autocollimator.noise");
    std::string text = "generator [arcsec],autocollimator x [arcsec],autocollimator y [arcsec]\n";
    for (const double way : {1.0, -1.0})
      for (int k = -100; k <= 100; ++k) {
        const double angle_arcsec = 2.0 * way * k;
        text += fmt::format("{},{:.4f},{:.4f}\n", angle_arcsec, scale * angle_arcsec + 0.3 * std::sin(units::turn * angle_arcsec / period_arcsec) + 0.03 * noise.Normal(), 0.03 * noise.Normal());
      }
    const Imported taken = Take(text);
    const diagnose::Diagnosis found = Diagnosed(taken);
    SCOPED_TRACE(fmt::format("{} {}", scale, period_arcsec));
    const auto ripple = std::ranges::find(found.causes, "autocollimator_periodic", &diagnose::Cause::effect);
    ASSERT_NE(ripple, found.causes.end());
    const auto& period = *std::ranges::find(ripple->parameters, "period", &diagnose::ParameterEstimate::name);
    EXPECT_NEAR(period.value, std::abs(scale) * period_arcsec * units::arcsec, 3.0 * period.u);
    EXPECT_LT(period.u, 0.01 * period.value);
    EXPECT_FALSE(ripple->indistinguishable_from.empty());
    EXPECT_THAT(found.notes, testing::Contains(HasSubstr("looks like one of")));
  }
}

/// Uneven steps tell a short one.
TEST_F(AutocollimatorSweep, OfUnevenStepsHasAShortPeriod) {
  Stream noise(8, "autocollimator.noise");
  std::string text = "generator [arcsec],autocollimator x [arcsec]\n";
  for (int k = 0; k < 200; ++k) {
    const double angle_arcsec = 2.0 * k - 200.0 + 1.6 * noise.Uniform();
    text += fmt::format("{:.3f},{:.4f}\n", angle_arcsec, angle_arcsec + 0.3 * std::sin(units::turn * angle_arcsec / 1.71) + 0.03 * noise.Normal());
  }
  const Imported taken = Take(text);
  const diagnose::Diagnosis found = Diagnosed(taken);
  ASSERT_FALSE(found.causes.empty());
  const auto& period = *std::ranges::find(found.causes[0].parameters, "period", &diagnose::ParameterEstimate::name);
  EXPECT_NEAR(period.value / units::arcsec, 1.71, 0.001);
  EXPECT_TRUE(found.causes[0].indistinguishable_from.empty());
}

/// One row that is far off neither widens the scale nor is a ripple.
TEST_F(AutocollimatorSweep, LeavesASingleRowOut) {
  constexpr int kFarRow = 161;
  Stream noise(9, "sweep");
  std::string text = "reference [arcsec],x [arcsec]\n";
  for (int k = 0; k < 241; ++k) {
    const double angle_arcsec = k <= 120 ? 3.0 * k - 180.0 : 180.0 - 3.0 * (k - 120);
    text += fmt::format("{:.2f},{:.4f}\n", angle_arcsec, 1.004 * angle_arcsec + 0.05 * noise.Normal() + (k == kFarRow ? 4.0 : 0.0));
  }
  const Imported taken = Take(text);
  const report::Evaluation evaluation = Evaluated(taken);
  ASSERT_EQ(evaluation.results.at("far").size(), 1U) << evaluation.summary;
  EXPECT_EQ(evaluation.results.at("far").at(0).at("reading"), kFarRow);
  EXPECT_NEAR(evaluation.results.at("far").at(0).at("off_arcsec").get<double>(), 4.0, 0.3);  // five of 0.06
  const auto& scale = evaluation.results.at("autocollimator").at("scale");
  EXPECT_NEAR(scale.at("value").get<double>(), 1.004, 3.0 * scale.at("u").get<double>());
  EXPECT_LT(scale.at("u").get<double>(), 4e-5);  // 0.05 / (105 sqrt(241)) = 3.1e-5
  EXPECT_THAT(evaluation.summary, HasSubstr("doubtful: x of reading 161"));
}

/// The turns of an axis beside what its encoder shows are no sweep of an autocollimator.
TEST_F(AutocollimatorSweep, IsNoComparisonOfTurns) {
  std::string text = "reference [deg],x [deg]\n";
  for (int k = 0; k < 73; ++k) text += fmt::format("{},{:.5f}\n", 5 * k, 5 * k + 0.01 * std::sin(0.3 * k));
  EXPECT_EQ(Take(text, "", {}).bench, "encoder_comparison");
}

class SpindleProbe : public Importing {
 protected:
  static double In(const Reading& r, const char* column) { return Quantity{column}(r); }
};

TEST_F(SpindleProbe, IsGuessedByItsProbes) {
  std::string text = "angle_deg,probe_x_um,probe_y_um,tilt_x_arcsec,tilt_y_arcsec\n";
  for (int k = 0; k < 144; ++k)
    text += fmt::format("{},{:.4f},{:.4f},{:.4f},{:.4f}\n", 5 * k, 1.0 + 0.01 * k, 2.0, -0.5, 0.25 * k);
  const Imported taken = TakeReadings(144, text);
  ASSERT_EQ(taken.bench, "rotary_4dof") << taken.story;
  EXPECT_THAT(taken.story, HasSubstr("taken as --map spindle_probe"));
  EXPECT_NEAR(taken.readings[100].target_rad / units::deg, 140.0, 1e-9) << "an angle that goes on starts again at a turn";
  EXPECT_NEAR(In(taken.readings[100], "probe_1_um") / units::um, 2.0, 1e-9);
  EXPECT_NEAR(In(taken.readings[100], "probe_tilt_y_arcsec") / units::arcsec, 25.0, 1e-9);
  EXPECT_TRUE(std::isnan(In(taken.readings[100], "probe_axial_um")));
}

/// A number that only tells a spindle's record from that of a screw is nobody's column.
TEST_F(SpindleProbe, LooksAtWhatTheFileHas) {
  std::string text = "angle_deg,probe_x_um\n";
  for (int k = 0; k < 144; ++k) text += fmt::format("{},{:.4f}\n", 5 * k, 0.01 * (k % 72));
  const Seen seen = Look({File("raw.csv", text)}, {});
  EXPECT_THAT(seen.text, Says("spindle_probe", "probe_1_um"));
  EXPECT_THAT(seen.text, Not(HasSubstr("alone")));
}

/// Such readings are whole although no voltage is there, in a file as well, whose columns are those that were read.
TEST_F(SpindleProbe, StaysWholeInAFile) {
  std::string text = "Winkel [°];Taster X [mm];Taster Y [mm];axial [nm]\n";
  for (int k = 0; k < 100; ++k)
    text += fmt::format("{};{:.6f};{:.6f};{}\n", (18 * k) % 360, 0.001 * k, 0.002, 10 * k);
  const Imported taken = Take(text, "spindle_probe");
  std::stringstream file;
  WriteReadingsCsv(taken.readings, taken.bench, file);
  EXPECT_THAT(file.str(), HasSubstr("probe_axial_um"));
  EXPECT_THAT(file.str(), Not(HasSubstr("probe_tilt_x_arcsec")));
  const std::vector<Reading> read = ParseReadingsCsv(file, "again.csv", taken.bench);
  ASSERT_EQ(read.size(), 100U);
  for (const Reading& r : read) EXPECT_EQ(r.status, ReadingStatus::kOk);
  EXPECT_NEAR(In(read[7], "probe_1_um") / units::um, 7.0, 1e-9);
  EXPECT_NEAR(In(read[7], "probe_axial_um") / units::um, 0.07, 1e-9);
}

TEST_F(SpindleProbe, KnowsAReversal) {
  std::string text = "theta (rad)\tprobe 1 (um)\torientation\n";
  for (const char* way : {"normal", "reversed"})
    for (int k = 0; k < 72; ++k) text += fmt::format("{:.6f}\t{:.3f}\t{}\n", units::turn * k / 24.0, 0.1 * k, way);
  const Imported taken = Take(text, "spindle_probe");
  EXPECT_EQ(taken.readings.front().setup, 0);
  EXPECT_EQ(taken.readings.back().setup, 1);
  EXPECT_THAT(taken.set, testing::Contains("probes.reversed_mounting=1"));
}

/// In any order: probe 1 is the one with the smallest angle.
TEST_F(SpindleProbe, HasTheAnglesInTheNamesOfItsProbes) {
  const auto text = [](const std::string& names) {
    std::string all = names + "\n";
    for (int k = 0; k < 144; ++k) all += fmt::format("{},{},{},{},{}\n", k / 72, 5 * (k % 72), 2000 + k, 1000 + k, 3000 + k);
    return all;
  };
  for (const char* names : {"rev,angle [deg],sensor 100 deg [nm],sensor 0 deg [nm],sensor 213 deg [nm]", "rev,angle_deg,S_100_nm,S_0_nm,S_213_nm"}) {
    const Imported taken = Take(text(names));
    ASSERT_EQ(taken.bench, "rotary_4dof") << taken.story;
    EXPECT_THAT(taken.set, testing::Contains("probes.angles_deg=[0, 100, 213]"));
    EXPECT_NEAR(In(taken.readings[9], "probe_1_um") / units::um, 1.009, 1e-9);
    EXPECT_NEAR(In(taken.readings[9], "probe_3_um") / units::um, 3.009, 1e-9);
    EXPECT_EQ(taken.readings[9].direction, 1) << "rev numbers the turns";
  }
  EXPECT_EQ(Take(text("rev,angle_deg,cap1_nm,cap2_nm,Cap_3_nm")).bench, "rotary_4dof");
  const Imported stated = Take(text("Sensor angles: 5; 100; 213 deg\nrev,angle [deg],s1 [nm],s2 [nm],s3 [nm]"));
  EXPECT_THAT(stated.set, testing::Contains("probes.angles_deg=[5, 100, 213]"));
}

/// One length that stays small while the angle goes round is a runout; one that goes on is a screw's.
TEST_F(SpindleProbe, MayBeAlone) {
  for (const char* names : {"Winkel [°];Weg [µm]", "spindle angle [deg];runout [um]", "angle_deg;axial_um"}) {
    std::string text = std::string(names) + "\n";
    for (int k = 0; k < 216; ++k) text += fmt::format("{};{:.4f}\n", (5 * k) % 360, 3.0 * std::cos(10.0 * k * units::deg));
    EXPECT_THAT(Take(text).story, HasSubstr("taken as --map spindle_probe")) << names;
  }
  std::string screw = "angle [deg];x [mm]\n";
  for (int k = 0; k < 216; ++k) screw += fmt::format("{};{:.5f}\n", 5 * k, 5 * k / 72.0);
  EXPECT_THAT(Take(screw).story, Not(HasSubstr("spindle_probe")));
}

/// Without units nothing is guessed, and what the names look like is said.
TEST_F(SpindleProbe, WithoutUnitsIsNamed) {
  std::string text = "theta,p1,p2\n";
  for (int k = 0; k < 40; ++k) text += fmt::format("{},{},{}\n", 10 * k, k % 7, k % 5);
  EXPECT_THAT(MessageOf([&] { Take(text); }), HasSubstr("--map spindle_probe"));
}

}  // namespace
}  // namespace twinbench::imports
