#include "tests/support/angle_benches.h"
#include "twin/benches/turntable_autocollimator/twin/effect.h"
#include "twin/benches/turntable_autocollimator/twin/twin.h"
#include "twin/sim/table_motion.h"

namespace twinbench {
namespace {

using units::arcsec, units::deg;

/// A bench without errors and noise: 12 positions, one set-up, one pass.
Scenario QuietTurntable(const std::vector<std::string>& but = {}) {
  return ParseScenario("bench = \"turntable_autocollimator\"\nnoise_free = true\nmultitooth.tooth_rms_arcsec = 0.0\n[turntable_procedure]\n"
                       "phases = [\"full_circle\"]\npositions = 12\ntilts_arcsec = [0.0]\neccentricities_um = [0.0]\npasses = [1]\n",
                       "quiet.toml", "", but);
}

std::vector<Reading> TurntableReadings(const Scenario& scenario) { return test::RunBench(scenario).readings; }

double X_arcsec(const Reading& r) { return r.autocollimator_yaw_rad / arcsec; }
double Y_arcsec(const Reading& r) { return r.autocollimator_tilt_rad / arcsec; }

// The reading is half the tangent of the doubled angle: at 100 arcsec 3e-5 arcsec more than the angle.
constexpr double kTangent_arcsec = 1e-4;

TEST(TurntableTwin, SeatsItsTeethWithTheScattersOfScenarioAndEffectInSquares) {
  Scenario s = QuietTurntable();
  double& sd_rad = TurntableOf(s).multitooth_table.repeatability_sd[static_cast<std::size_t>(Component::kEz)];
  sd_rad = 0.4 * arcsec;
  EffectSettings seating;
  seating.name = "multitooth_seating";
  seating.parameters["scatter"] = 0.3 * arcsec;
  sim::MakeTurntableEffect(seating, s)->AlterBench(s);
  EXPECT_NEAR(sd_rad / arcsec, 0.5, 1e-12);
}

TEST(TurntableTwin, ReadsTheIndexErrorOfTheTurntablePlusThatOfTheTooth) {
  Scenario s = QuietTurntable();
  TurntableOf(s).turntable.harmonics = {{Component::kEz, 2.0, 5.0 * arcsec, 0.3}};
  TurntableOf(s).multitooth_table.harmonics = {{Component::kEz, 3.0, 2.0 * arcsec, 1.0}};
  TurntableOf(s).turntable_procedure.shifts = {30};  // teeth
  for (const Reading& r : TurntableReadings(s)) {
    const double turntable_rad = r.position * 30.0 * deg, tooth_rad = 30.0 * deg - turntable_rad;
    EXPECT_NEAR(r.target_rad, turntable_rad, 1e-12);
    EXPECT_NEAR(r.reference_rad, tooth_rad, 1e-12);
    const double sum_arcsec = 5.0 * std::cos(2.0 * turntable_rad + 0.3) + 2.0 * std::cos(3.0 * tooth_rad + 1.0);
    EXPECT_NEAR(X_arcsec(r), sum_arcsec, kTangent_arcsec) << r.position;
    EXPECT_NEAR(Y_arcsec(r), 0.0, kTangent_arcsec);
  }
}

TEST(TurntableTwin, ShowsATiltOfTheMultitoothTableOnceATurnInY) {
  const Scenario s = QuietTurntable({"turntable_procedure.tilts_arcsec=[100]", "turntable_procedure.tilt_azimuths_deg=[40]"});
  for (const Reading& r : TurntableReadings(s)) {
    // The axis leans towards the azimuth, so the normal of a mirror that faces that way looks down.
    const double azimuth_rad = 40.0 * deg + r.target_rad;
    EXPECT_NEAR(Y_arcsec(r), -100.0 * std::sin(azimuth_rad), 2.0 * kTangent_arcsec) << r.position;
    EXPECT_NEAR(X_arcsec(r), 0.0, 0.03) << "second order: 100 arcsec x 1e-4";
  }
}

TEST(TurntableTwin, ReadsTheMeanOfItsFramesInTheirMiddleWithLessNoise) {
  const Reading once = TurntableReadings(QuietTurntable()).back();
  Scenario s = QuietTurntable({"autocollimator.frames=21", "autocollimator.frame_s=0.1"});
  // The last of twelve has eleven whole readings of 2 s before it and half its own.
  EXPECT_NEAR(ToSeconds(TurntableReadings(s).back().time - once.time), 11.5 * 2.0, 0.2)
      << "the drives look for rest by their own ticks";
  s = Altered(s, {"environment.drift_K_h=100", "environment.sensor_noise_mK=0"});
  const Reading warmer = TurntableReadings(s).back();
  EXPECT_NEAR(warmer.temperature_degC, 20.0 + 100.0 * ToSeconds(warmer.time) / 3600.0, 1e-9) << "a second is 28 mK";
  s = Altered(s, {"noise_free=false", "turntable_procedure.positions=360", "autocollimator.frames=16"});
  double squares = 0.0;
  for (const Reading& r : TurntableReadings(s)) squares += std::pow(r.autocollimator_yaw_rad, 2);
  // 360 readings: 3.7 % of the deviation; four of these.
  EXPECT_NEAR(std::sqrt(squares / 360.0) / (TurntableOf(s).autocollimator.noise_rad / 4.0), 1.0, 0.15);
}

TEST(TurntableTwin, SweepsTheTurntableAloneForTheCalibration) {
  const auto readings = TurntableReadings(QuietTurntable(
      {"turntable_procedure.phases=[\"calibration\"]", "turntable_procedure.sweep_points=5", "autocollimator.gain_error=0.01"}));
  ASSERT_EQ(readings.size(), 5u);
  for (const Reading& r : readings) {
    EXPECT_EQ(r.phase, Phase::kCalibration);
    EXPECT_EQ(r.reference_rad, 0.0);
    EXPECT_NEAR(X_arcsec(r), 1.01 * r.target_rad / arcsec, 1e-3);
  }
  EXPECT_NEAR(readings.front().target_rad, -200.0 * arcsec, 1e-12);
}

TEST(TurntableTwin, ChecksBetweenThePositionsOnlyOnWholeTeethEvenlySpread) {
  const Scenario s = QuietTurntable({"turntable_procedure.phases=[\"verification\"]", "turntable_procedure.verification_positions=20"});
  for (const Reading& r : TurntableReadings(s)) {
    EXPECT_EQ(r.phase, Phase::kVerification);
    EXPECT_NE(std::lround(r.target_rad / deg) % 30, 0) << "a position of the full circle";
  }
  const std::vector<int> teeth = procedure::CheckTeeth(360, 72, 144);
  EXPECT_EQ(teeth.size(), 144u);
  EXPECT_EQ(std::vector<int>(teeth.begin(), teeth.begin() + 5), (std::vector<int>{1, 3, 6, 8, 11}));
}

TEST(TurntableTwin, ShowsNothingBeyondTheRange) {
  const auto readings = TurntableReadings(QuietTurntable({"turntable.harmonics=[{order=1, amplitude_arcsec=500}]"}));
  EXPECT_EQ(readings[0].status, ReadingStatus::kClippedSpot) << "500 arcsec at a range of 410";
  EXPECT_TRUE(std::isnan(readings[0].autocollimator_yaw_rad));
  EXPECT_EQ(readings[3].status, ReadingStatus::kOk);
}

// The turntable's twin on the course of a record says what the readings should have been.

/// A noise-free run with errors of both tables, two set-ups, all phases.
Scenario Careful() {
  return ParseScenario(R"(bench = "turntable_autocollimator"
noise_free = true
turntable.harmonics = [{ order = 1, amplitude_arcsec = 6, phase_deg = 17 },
                       { component = "ex", order = 2, amplitude_arcsec = 2, phase_deg = 57 }]
multitooth.harmonics = [{ order = 3, amplitude_arcsec = 1, phase_deg = 23 }]
autocollimator.roll_mrad = 5
[turntable_procedure]
phases = ["calibration", "full_circle", "verification"]
positions = 12
tilt_azimuths_deg = [20, 130]
shifts_teeth = [0, 30]
dwell_s = [0.5, 2, 8]
verification_positions = 7
)",
                       "careful.toml", "");
}

Eigen::VectorXd Each(const std::vector<Reading>& readings, const std::function<double(const Reading&)>& value) {
  Eigen::VectorXd values(std::ssize(readings));
  for (Eigen::Index i = 0; i < values.size(); ++i) values[i] = value(readings[static_cast<std::size_t>(i)]);
  return values;
}

/// What the run leaves free, given at its points.
std::vector<model::Disturbance> OwnErrors(const test::BenchRun& run) {
  const Scenario& s = run.scenario;
  const sim::TableMotion multitooth(TurntableOf(s).multitooth_table, s, "multitooth");
  const auto teeth = run.truth["multitooth"]["ez_arcsec"].get<std::vector<double>>();
  const auto tooth_rad = [&](const Reading& r) {
    const auto n = static_cast<long>(teeth.size());
    const long tooth = std::lround(r.reference_rad / (2.0 * units::kPi) * static_cast<double>(n));
    return teeth[static_cast<std::size_t>(((tooth % n) + n) % n)] * arcsec;
  };
  // The rotor is where the gap lets it stay.
  const auto rotor_rad = [&](const Reading& r) {
    return r.target_rad - 0.5 * r.direction * TurntableOf(s).turntable.backlash_rad;
  };
  std::vector<model::Disturbance> errors;
  const std::array<const char*, kComponents> names = {"ex", "ey", "ez", "dx", "dy", "dz"};
  for (std::size_t c = 0; c < kComponents; ++c) {
    const auto of = [c](const mechanics::PoseError& e) { return e.Array()[c]; };
    const std::string name = names[c];
    TableSettings repeats = TurntableOf(s).turntable;
    repeats.half_frequency_tilt_rad = repeats.half_frequency_radial_m = 0.0;  // the twin knows it
    const sim::TableMotion motion(repeats, s, "turntable");
    errors.push_back(
        {"turntable." + name, Each(run.readings, [&](const Reading& r) { return of(motion.At(rotor_rad(r))); })});
    if (name != "ez")
      errors.push_back({"multitooth." + name,
                        Each(run.readings, [&](const Reading& r) { return of(multitooth.At(r.reference_rad)); })});
  }
  errors.push_back({"multitooth.ez", Each(run.readings, tooth_rad)});
  return errors;
}

/// Largest difference between the run's readings and what its own twin says [arcsec].
double TurntableOff_arcsec(const Scenario& scenario) {
  const test::BenchRun run = test::RunBench(scenario);
  const auto follow = sim::FollowTurntable(scenario, run.readings);
  const Eigen::MatrixXd predicted_rad = follow->Predict(OwnErrors(run));
  Eigen::MatrixXd shown_rad(predicted_rad.rows(), 2);
  shown_rad << Each(run.readings, &Reading::autocollimator_yaw_rad), Each(run.readings, &Reading::autocollimator_tilt_rad);
  for (const Reading& r : run.readings) EXPECT_EQ(r.status, ReadingStatus::kOk);
  return (predicted_rad - shown_rad).cwiseAbs().maxCoeff() / arcsec;
}

constexpr double kSameTurntable_arcsec = 1e-6;

TEST(TurntableFollow, SaysWhatTheRunShowedAndKnowsEveryEffectOfTheCatalogue) {
  EXPECT_LT(TurntableOff_arcsec(Careful()), kSameTurntable_arcsec);
  for (const EffectEntry& entry : EffectCatalogue(kTurntableBench)) {
    if (entry.name == "outliers") continue;  // nobody can foresee them
    Scenario s = Careful();
    s.environment.drift_K_h = 2.0;
    s.effects = {test::PlainEffect(entry)};
    EXPECT_LT(TurntableOff_arcsec(s), kSameTurntable_arcsec) << entry.name;
  }
}

TEST(TurntableFollow, KnowsTheKeysOfTheScenario) {
  const std::string settling = "effect=[{ name = \"settling\", amplitude_arcsec = 2, time_constant_s = 1 }]";
  const std::string creep =
      "effect=[{ name = \"mount_creep\", where = \"x\", amplitude_arcsec = 2, time_constant_s = 60 }]";
  const std::vector<std::vector<std::string>> changes = {
      {"turntable.backlash_arcsec=3"}, {"turntable.half_frequency_tilt_arcsec=2"}, {"mirror.flatness_nm=5000"},
      {"turntable_procedure.eccentricities_um=[1000, 3000]"}, {"mirror.radius_mm=200"},
      {"autocollimator.aperture_mm=70"}, {"mirror.width_mm=20"}, {"autocollimator.gain_error=0.01"},
      {"autocollimator.error_at_edge_arcsec=5"}, {"autocollimator.interpolation_error_px=0.1"},
      {"autocollimator.x_per_kelvin_arcsec=2", "environment.swing_mK=500", "environment.swing_period_s=1000"},
      {"turntable_procedure.tilts_arcsec=[200, -250]"},
      {"turntable_procedure.run_up_steps=0", "effect=[{ name = \"backlash\", width_arcsec = 2 }]"},
      {"turntable.move_time_s=6", settling}, {"mechanics.fidelity=linear"}, {"multitooth.teeth=720"},
      {"turntable_procedure.phases=[\"verification\", \"full_circle\", \"calibration\"]", creep}};
  for (const auto& keys : changes)
    EXPECT_LT(TurntableOff_arcsec(Altered(Careful(), keys)), kSameTurntable_arcsec) << keys[0];
}

/// Where nothing else errs.
TEST(TurntableFollow, GoesWhereACompensationLeads) {
  Scenario s = Careful();
  TurntableOf(s).turntable.harmonics = {};
  TurntableOf(s).turntable.compensation = CompensationTable{{0.0, 120.0 * deg, 240.0 * deg}, {0.0, 6.0 * arcsec, -3.0 * arcsec}};
  EXPECT_LT(TurntableOff_arcsec(s), kSameTurntable_arcsec);
}

// Settled means within a hundredth of an arcsecond.
TEST(TurntableFollow, DiffersFromBulletByLessThanTheServosWindow) {
  const std::vector<std::string> one_circle = {"turntable_procedure.phases=[\"full_circle\"]", "turntable_procedure.tilts_arcsec=[60]",
                                               "turntable_procedure.shifts_teeth=[0]", "turntable_procedure.tilt_azimuths_deg=[0]",
                                               "mechanics.fidelity=bullet"};
  EXPECT_LT(TurntableOff_arcsec(Altered(Careful(), one_circle)), 0.02);
}

/// d reading / d point: readings x 2, at the errors of the run.
Eigen::MatrixXd SlopeAt(const Scenario& scenario, const char* point) {
  const test::BenchRun run = test::RunBench(scenario);
  const auto follow = sim::FollowTurntable(scenario, run.readings);
  return model::Slope(*follow, model::PointNamed(*follow, point), OwnErrors(run));
}

// A roll g shows x' = x cos g + y sin g, y' = y cos g - x sin g; a scale stretches both.
TEST(TurntableFollow, SlopesAreThoseOfARolledAndStretchedCrosshair) {
  const Scenario s = Altered(Careful(), {"autocollimator.gain_error=0.01", "turntable_procedure.tilts_arcsec=[0]", "turntable.harmonics=[]",
                                         "multitooth.harmonics=[]"});
  const double scale = 1.01, g = 5e-3;
  const Eigen::MatrixXd x = SlopeAt(s, "turntable.ez"), y = SlopeAt(s, "turntable.ex");
  // In a sweep of 200 arcsec the tangent is steeper than the angle by 4e-6.
  for (Eigen::Index i = TurntableOf(s).turntable_procedure.sweep_points; i < x.rows(); ++i) {
    EXPECT_NEAR(x(i, 0), scale * std::cos(g), 1e-6);
    EXPECT_NEAR(x(i, 1), -scale * std::sin(g), 1e-6);
    EXPECT_NEAR(y(i, 0), scale * std::sin(g), 1e-6);
    EXPECT_NEAR(y(i, 1), scale * std::cos(g), 1e-6);
  }
}

TEST(TurntableFollow, HasPointsForWhatItsErrorsAreMadeOf) {
  const Scenario s = Altered(Careful(), {"turntable_procedure.tilts_arcsec=[0]", "autocollimator.roll_mrad=0"});
  const test::BenchRun run = test::RunBench(s);
  const auto follow = sim::FollowTurntable(s, run.readings);
  const Eigen::MatrixXd shown = model::Slope(*follow, model::PointNamed(*follow, "autocollimator.y"));
  EXPECT_NEAR((shown.col(1).array() - 1.0).abs().maxCoeff(), 0.0, 1e-6);
  EXPECT_NEAR(shown.col(0).cwiseAbs().maxCoeff(), 0.0, 1e-6);
  const Eigen::MatrixXd roll = model::Slope(*follow, model::PointNamed(*follow, "autocollimator.roll"));
  EXPECT_EQ(roll.rows(), std::ssize(run.readings)) << "a constant of the bench is a point, too";
  EXPECT_THROW(follow->Predict({{"turntable.ez", Eigen::VectorXd::Zero(3)}}), std::logic_error);
  EXPECT_THROW(model::PointNamed(*follow, "laser.yaw"), std::logic_error);
}

}  // namespace
}  // namespace twinbench
