#include "tests/import/raw_files.h"
#include "tests/tools/program.h"

/// From a raw file to a diagnosis with two commands, for every layout that is known.
namespace twinbench::test {
namespace {

using testing::Contains, testing::HasSubstr;

class TwoCommands : public Program {
 protected:
  /// Imports `text` and diagnoses it. @return the effects that are named or tied.
  std::set<std::string> Named(const std::string& file, const std::string& text,
                              const std::vector<std::string>& options) {
    Write(file, text);
    story_ = Succeed(With({"import", file, "-o", "run"}, options));
    found_ = Json({"diagnose", "run", "--json", "-"});
    std::set<std::string> effects;
    for (const auto& cause : found_.at("causes")) effects.insert(cause.at("effect"));
    return effects;
  }
  double Parameter(const std::string& effect, const std::string& name) const {
    for (const auto& cause : found_.at("causes")) {
      if (cause.at("effect") == effect) return cause.at("parameters").at(name).at("value");
    }
    return std::nan("");
  }

  std::string story_;
  nlohmann::json found_;
};

double LostMotion(double, int sense) { return sense > 0 ? 0.0 : 0.05; }
double OncePerTurn(double angle_deg, int) { return 0.05 * Cosine(1.0, angle_deg, 40.0); }

TEST_F(TwoCommands, TakeAPositioningReportToItsReversalError) {
  Noise noise(0.0006, 3);
  const auto actual_mm = [&](double target, int sense, int) {
    return target - (sense < 0 ? 0.012 : 0.0) + noise();
  };
  EXPECT_THAT(
      Named("report.md", PositioningReport({0.0, 50.1, 99.8, 150.3, 200.2, 249.9, 300.4, 349.7}, 5, actual_mm),
            {"--map", "iso230"}),
      Contains("backlash"));
  for (const auto& cause : found_.at("causes")) {
    if (cause.at("effect") != "backlash") continue;
    EXPECT_EQ(cause.at("parameters").at("width").at("unit"), "mm") << "a linear axis errs in lengths";
  }
  EXPECT_THAT(story_, HasSubstr("ISO 230-2, µm"));
}

TEST_F(TwoCommands, TakeTwoColumnsToTheOffCentreScale) {
  std::string text = "reference,encoder\n";
  for (const auto& s : DriveAxis(
           {.turns = 1.0, .speed_deg_s = 100.0, .interval_s = 0.05, .rest_s = 0.0, .passes = {1, -1}}, OncePerTurn))
    text += fmt::format("{:.4f},{:.4f}\n", OnceRound(s.angle_deg), OnceRound(s.shown_deg));
  EXPECT_THAT(Named("two.csv", text, {}), Contains("eccentricity"));
  EXPECT_THAT(story_, HasSubstr("unwrapped"));
}

/// scenarios/samples/ball_bar.py says what it hid.
TEST_F(TwoCommands, TakeABallBarToTheErrorsOfTheMachine) {
  const std::set<std::string> named = Named("bar.csv", Contents(std::string(TWINBENCH_SOURCE_DIR) + "/scenarios/samples/ball_bar.csv"), {});
  EXPECT_THAT(named, testing::IsSupersetOf({"squareness", "backlash", "scale"}));
  EXPECT_NEAR(Parameter("squareness", "angle"), 8.25, 0.15);
  EXPECT_NEAR(Parameter("backlash", "width"), 4.0, 0.1);
  const nlohmann::json results = JsonIn("run/results.json"), &errors = results.at("errors");
  EXPECT_NEAR(errors.at("machine.squareness_arcsec").at("value").get<double>(), 8.25, 0.1);
  EXPECT_NEAR(errors.at("machine.scale_mismatch_um_m").at("value").get<double>(), 17.0, 1.0);
  EXPECT_FALSE(errors.contains("machine.scale_x_um_m")) << "a radius does not show it";
  // Squareness s alone makes an ellipse of half axes R +- s R / 2, backlash alone lowers one half of each circle by half of it and
  // raises the other.
  std::map<std::string, double> alone_um;
  for (const auto& ranked : results.at("ranked")) alone_um[ranked.at("error")] = ranked.at("share_um");
  EXPECT_NEAR(alone_um["squareness"], 4.0, 0.05);
  EXPECT_NEAR(alone_um["backlash x"], 4.0, 0.1);
}

/// scenarios/samples/gear_train.py says what it hid.
TEST_F(TwoCommands, TakeAGearTrainToItsOrdersAndItsBacklash) {
  const std::set<std::string> named = Named("train.csv", Contents(std::string(TWINBENCH_SOURCE_DIR) + "/scenarios/samples/gear_train.csv"), {});
  EXPECT_THAT(named, testing::IsSupersetOf({"hob_runout", "backlash"}));
  EXPECT_NEAR(Parameter("backlash", "width"), 20.0, 0.1);
  EXPECT_NEAR(Parameter("hob_runout", "amplitude"), 15.0, 0.1);
  std::map<int, double> amplitude_arcsec;
  for (const auto& order : found_.at("harmonics")) amplitude_arcsec[order.at("order")] = 3600.0 * order.at("amplitude_deg").get<double>();
  EXPECT_NEAR(amplitude_arcsec[1], 42.0, 0.2);
  EXPECT_NEAR(amplitude_arcsec[2], 9.0, 0.2);
}

/// In even steps the lines of an encoder that nobody stated would be read at one phase.
TEST_F(TwoCommands, FindNothingInAGearTrainReadInEvenSteps) {
  Noise noise_deg(1.0 / 3600.0, 12);
  std::string text = "hob_deg,table_deg\n";
  for (int k = 0; k < 432; ++k) text += fmt::format("{:.4f},{:.6f}\n", 30.0 * k, 2.5 * k + noise_deg());
  EXPECT_THAT(Named("even.csv", text, {}), testing::IsEmpty());
}

/// Any number of rows a turn is enough for the orders that they show.
TEST_F(TwoCommands, TakeAGearTrainWithFewRowsATurn) {
  std::string text = "input_deg,output_deg\n";
  for (int k = 0; k < 110; ++k) text += fmt::format("{:.6f},{:.6f}\n", 21.6 * k, 7.2 * k + 0.01 * Cosine(1.0, 7.2 * k, 30.0));
  Write("few.csv", text);
  const std::string story = Succeed({"import", "few.csv", "-o", "few"});
  EXPECT_THAT(story, HasSubstr("order 1: 36.00 ±")) << "0.01 deg, of 50 rows a turn";
  EXPECT_THAT(story, HasSubstr("orders 1-20"));
  std::string folding = "input_deg,output_deg\n";
  for (int k = 0; k < 141; ++k) {
    const double out_deg = 360.0 * k / 47.0;
    folding += fmt::format("{:.6f},{:.6f}\n", 36.0 * out_deg, out_deg + 0.01 * Cosine(1.0, out_deg, 30.0) + 0.002 * Cosine(36.0, out_deg, 10.0));
  }
  Write("folding.csv", folding);
  EXPECT_THAT(Succeed({"import", "folding.csv", "-o", "folding"}), HasSubstr("11 or 36 (7.20)")) << "of 47 rows a turn";
}

/// 12 faces whose certified deviations are taken out; the table errs by 3 arcsec once a turn, and stands 0.2 arcsec off from the other side.
TEST_F(TwoCommands, TakeAFaceTableToTheErrorsOfTheTable) {
  Noise noise(0.02, 12);
  std::string text = "face,nominal_deg,certified_arcsec,reading_forward_arcsec,reading_reverse_arcsec\n";
  for (int k = 0; k < 12; ++k) {
    const double certified = 1.5 * std::sin(2.3 * k), table = 3.0 * Cosine(1.0, 30.0 * k, 40.0);
    text += fmt::format("{},{},{:.3f},{:.3f},{:.3f}\n", k + 1, 30 * k, certified, table + certified + noise(),
                        table + certified + 0.2 + noise());
  }
  EXPECT_THAT(Named("faces.csv", text, {}), Contains("backlash"));
  EXPECT_NEAR(Parameter("backlash", "width"), 0.2, 0.03);
  EXPECT_THAT(story_, HasSubstr("rms 2.1"));
  for (const auto& cause : found_.at("causes")) EXPECT_NE(cause.at("effect"), "autocollimator_drift") << "there is no clock";
  Succeed({"export", "run", "--readings", "again.csv"});
  EXPECT_EQ(Json({"diagnose", "again.csv", "--scenario", "run/scenario.toml", "--json", "-"}).at("verdict"), found_.at("verdict"));
}

/// scenarios/samples/face_table.py says what it hid.
TEST_F(TwoCommands, TakeClampingsOfAPolygonToTheErrorsOfTableAndFaces) {
  const std::vector<double> faces = {0.0, -1.2, 0.7,  2.1, -0.4, -1.9,
                                     0.9, 1.5,  -2.2, 0.3, 1.1,  -0.9};  // their mean is zero
  Named("faces.csv", Contents(std::string(TWINBENCH_SOURCE_DIR) + "/scenarios/samples/face_table.csv"), {});
  EXPECT_EQ(found_.at("verdict"), "none");
  const nlohmann::json separation = nlohmann::json::parse(Read("run/results.json")).at("separation");
  EXPECT_TRUE(separation.at("not_separable").empty());
  const nlohmann::json &table = separation.at("turntable"), &polygon = separation.at("multitooth");
  ASSERT_EQ(table.at("position_deg").size(), 12U);
  ASSERT_EQ(polygon.at("position_deg").size(), 12U);
  for (std::size_t k = 0; k < 12; ++k) {
    const double angle_deg = table.at("position_deg")[k], u = table.at("u_ez_arcsec")[k];
    const double true_arcsec = 2.4 * Cosine(1.0, angle_deg, -90.0 + 28.64788975654116) +
                               0.9 * Cosine(2.0, angle_deg, 0.0) + 0.4 * Cosine(6.0, angle_deg, 0.0);
    EXPECT_NEAR(table.at("ez_arcsec")[k], true_arcsec, 4.0 * u) << angle_deg;
    EXPECT_LT(u, 0.05);
    const auto face =
        static_cast<std::size_t>(std::lround(12.0 - polygon.at("position_deg")[k].get<double>() / 30.0)) % 12;
    EXPECT_NEAR(polygon.at("ez_arcsec")[k], faces[face], 4.0 * polygon.at("u_ez_arcsec")[k].get<double>())
        << "face " << face;
  }
}

/// scenarios/samples/autocollimator_sweep.py says what it hid.
TEST_F(TwoCommands, TakeASweepToTheScaleOfTheAutocollimator) {
  Write("sweep.csv", Contents(std::string(TWINBENCH_SOURCE_DIR) + "/scenarios/samples/autocollimator_sweep.csv"));
  EXPECT_THAT(Succeed({"import", "sweep.csv", "-o", "run"}), HasSubstr("scale                   1.004"));
  const nlohmann::json shown = nlohmann::json::parse(Read("run/results.json")).at("autocollimator");
  const auto expect = [&shown](const char* name, double truth, double most_u) {
    EXPECT_NEAR(shown.at(name).at("value"), truth, 4.0 * shown.at(name).at("u").get<double>()) << name;
    EXPECT_LT(shown.at(name).at("u"), most_u) << name;
  };
  expect("scale", 1.0042, 1e-4);
  expect("crosstalk_mrad", 3.0, 0.1);
  expect("reversal_arcsec", 0.0, 0.01);
  EXPECT_EQ(shown.at("sense"), 1);
  EXPECT_FALSE(shown.contains("nonlinearity_arcsec")) << "it is straight";
  ASSERT_EQ(shown.at("ripple").size(), 1U);
  const nlohmann::json& ripple = shown.at("ripple")[0];
  EXPECT_NEAR(ripple.at("period_arcsec"), 12.4, 4.0 * ripple.at("u_period_arcsec").get<double>());
  EXPECT_NEAR(ripple.at("amplitude_arcsec"), 0.21, 4.0 * ripple.at("u_amplitude_arcsec").get<double>());
}

/// scenarios/samples/spindle_probe.py says what it hid. Widths of its curves, less what noise adds to a width.
TEST_F(TwoCommands, TakeSpindleProbesToErrorMotions) {
  Write("spindle.csv", Contents(std::string(TWINBENCH_SOURCE_DIR) + "/scenarios/samples/spindle_probe.csv"));
  EXPECT_THAT(Succeed({"import", "spindle.csv", "-o", "run"}), HasSubstr("8 turns"));
  const nlohmann::json results = nlohmann::json::parse(Read("run/results.json"));
  const auto width = [](auto curve) {
    double low = 1e9, high = -1e9;
    for (int k = 0; k < 180; ++k) low = std::min(low, curve(2.0 * k)), high = std::max(high, curve(2.0 * k));
    return high - low;
  };
  const auto x = [](double deg) { return 0.6 * Cosine(2.0, deg, 0.0) + 0.25 * Cosine(5.0, deg, -90.0); };
  const auto y = [](double deg) { return 0.4 * Cosine(3.0, deg, 0.3 * 57.29577951308232); };
  std::map<std::string, nlohmann::json> found;
  for (const auto& motion : results.at("iso230_7")) found[motion.at("motion")] = motion.at("values");
  const auto expect = [&found](const char* motion, const char* value, double truth, const char* unit = "_um") {
    const nlohmann::json& v = found.at(motion).at(value);
    const double u = v.at(std::string("u") + unit), bias = v.at(std::string("bias") + unit);
    EXPECT_NEAR(v.at(std::string("value") + unit).get<double>() - bias, truth, 4.0 * u) << motion << " " << value;
    EXPECT_LT(u, 0.1 * truth) << motion << " " << value;
  };
  expect("radial_fixed_x", "synchronous", width(x));
  expect("radial_fixed_y", "synchronous", width(y));
  expect("axial", "fundamental", 0.6);
  expect("axial", "residual", 0.4);
  expect("tilt_fixed_x", "synchronous", 2.2, "_arcsec");
  expect("tilt_fixed_y", "synchronous", 1.6, "_arcsec");
  EXPECT_NEAR(found.at("radial_fixed_x").at("asynchronous").at("value_um"), 0.1, 0.06)
      << "3.5 a turn, twice 0.05 apart, and noise";
  EXPECT_NEAR(results.at("eccentricity").at("probe_1_um").at("value"), 9.0, 0.01);
  EXPECT_FALSE(results.contains("artefact")) << "two probes do not separate it";
  EXPECT_THAT(Call({"diagnose", "run"}).err, HasSubstr("not diagnosed"));
}

TEST_F(TwoCommands, LookBeforeAnythingIsWritten) {
  Write("hal.txt", HalSamples(DriveAxis({.turns = 0.1}, LostMotion)));
  const std::string text = Succeed({"import", "hal.txt", "--look", "--map", "halsampler"});
  EXPECT_THAT(text, HasSubstr("It would be imported like this"));
  EXPECT_FALSE(Exists("run"));
  EXPECT_THAT(Call({"import", "hal.txt"}).err, HasSubstr("-o FOLDER"));
}

TEST_F(TwoCommands, LookAndFailWhereNothingCanBeImported) {
  Write("abc.csv", "t,a,b,c\n0,1,2,3\n1,2,3,5\n2,3,4,9\n");
  const Outcome unclear = Call({"import", "abc.csv", "--look"});
  EXPECT_EQ(unclear.exit_code, 2);
  EXPECT_THAT(unclear.out, HasSubstr("a: 1 to 3"));
  EXPECT_THAT(unclear.err, HasSubstr("which column is reference_deg is not clear"));
  Write("three.csv", "reference [deg],measured [deg]\n0,0.1\n10,10.2\n20,20.1\n");
  EXPECT_EQ(Call({"import", "three.csv", "--look"}).exit_code, 2) << "three readings cannot be trusted";
}

TEST_F(TwoCommands, TellNoDurationOfARecordingThatNobodyTimed) {
  std::string text = "reference [deg],encoder [deg]\n";
  for (int k = 0; k < 144; ++k) text += fmt::format("{},{:.5f}\n", 2.5 * k, 2.5 * k + OncePerTurn(2.5 * k, 1));
  Write("list.csv", text);
  Succeed({"import", "list.csv", "-o", "run"});
  EXPECT_THAT(Succeed({"check", "run/scenario.toml"}), HasSubstr("\nhow long it takes is not known: the recording beside it has no clock\n"));
  EXPECT_TRUE(Json({"check", "run/scenario.toml", "--json", "-"}).at("expected").at("minutes").is_null());
  EXPECT_THAT(Succeed({"export", "run"}), HasSubstr("\n1,,0,"));
}

}  // namespace
}  // namespace twinbench::test
