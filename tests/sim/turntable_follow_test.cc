#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/angle_benches.h"
#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/benches/turntable_autocollimator/twin/follow.h"
#include "twin/sim/table_motion.h"

// The turntable's twin on the course of a record says what the readings should have been.
namespace twinbench {
namespace {

using units::arcsec, units::deg;

/// A noise-free run with errors of both tables, two set-ups, all phases.
Scenario Careful() {
  Scenario s;
  s.bench = kTurntableBench;
  s.noise_free = true;
  TurntableOf(s).turntable.harmonics = {{Component::kEz, 1.0, 6.0 * arcsec, 0.3},
                                        {Component::kEx, 2.0, 2.0 * arcsec, 1.0}};
  TurntableOf(s).multitooth_table.harmonics = {{Component::kEz, 3.0, 1.0 * arcsec, 0.4}};
  TurntableOf(s).collimator.roll_rad = 5e-3;
  TurntableOf(s).turntable_procedure.phases = {"calibration", "full_circle", "verification"};
  TurntableOf(s).turntable_procedure.positions = 12;
  TurntableOf(s).turntable_procedure.tilt_azimuths_rad = {20.0 * deg, 130.0 * deg};
  TurntableOf(s).turntable_procedure.shifts = {0, 30};
  TurntableOf(s).turntable_procedure.dwell_s = {0.5, 2.0, 8.0};
  TurntableOf(s).turntable_procedure.verification_positions = 7;
  return s;
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
  const test::BenchRun run = test::RunTurntable(scenario);
  const auto follow = sim::FollowTurntable(scenario, run.readings);
  const Eigen::MatrixXd predicted_rad = follow->Predict(OwnErrors(run));
  double off_rad = 0.0;
  for (Eigen::Index i = 0; i < predicted_rad.rows(); ++i) {
    const Reading& r = run.readings[static_cast<std::size_t>(i)];
    EXPECT_EQ(r.status, ReadingStatus::kOk);
    off_rad = std::max({off_rad, std::abs(predicted_rad(i, 0) - r.autocollimator_yaw_rad),
                        std::abs(predicted_rad(i, 1) - r.autocollimator_tilt_rad)});
  }
  return off_rad / arcsec;
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

// Settled means within a hundredth of an arcsecond.
TEST(TurntableFollow, DiffersFromBulletByLessThanTheServosWindow) {
  Scenario s = Careful();
  TurntableOf(s).mechanics.fidelity = "bullet";
  TurntableOf(s).turntable_procedure.phases = {"full_circle"};
  TurntableOf(s).turntable_procedure.tilts_rad = {60.0 * arcsec};
  TurntableOf(s).turntable_procedure.shifts = {0};
  TurntableOf(s).turntable_procedure.tilt_azimuths_rad = {0.0};
  EXPECT_LT(TurntableOff_arcsec(s), 0.02);
}

/// d reading / d point: readings x 2, at the errors of the run.
Eigen::MatrixXd SlopeAt(const Scenario& scenario, const char* point) {
  const test::BenchRun run = test::RunTurntable(scenario);
  const auto follow = sim::FollowTurntable(scenario, run.readings);
  return model::Slope(*follow, model::PointNamed(*follow, point), OwnErrors(run));
}

// A roll g shows x' = x cos g + y sin g, y' = y cos g - x sin g; a scale stretches both.
TEST(TurntableFollow, SlopesAreThoseOfARolledAndStretchedCrosshair) {
  Scenario s = Careful();
  TurntableOf(s).autocollimator.gain_error = 0.01;
  TurntableOf(s).turntable_procedure.tilts_rad = {0.0};
  TurntableOf(s).turntable.harmonics = TurntableOf(s).multitooth_table.harmonics = {};
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
  Scenario s = Careful();
  TurntableOf(s).turntable_procedure.tilts_rad = {0.0};
  TurntableOf(s).collimator.roll_rad = 0.0;
  const test::BenchRun run = test::RunTurntable(s);
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
