#include "tests/core/input_error.h"
#include "tests/support/angle_benches.h"
#include "tests/support/kept_text.h"
#include "twin/benches/turntable_autocollimator/twin/twin.h"

// A polygon on the turntable: each face is nulled by turning the table, and the encoder is read.
namespace twinbench {
namespace {

using units::arcsec, units::deg;

/// Twelve faces without errors, three clampings, without noise.
Scenario QuietPolygon() {
  Scenario s;
  s.bench = kTurntableBench;
  s.noise_free = true;
  TurntableSettings& own = TurntableOf(s);
  own.polygon.faces = 12;
  own.collimator.deadband_rad = 1e-3 * arcsec;
  own.turntable_procedure.phases = {"full_circle"};
  own.turntable_procedure.positions = 12;
  own.turntable_procedure.polygon_offsets_rad = {0.0, 17.0 * deg, 250.0 * deg};
  own.turntable_procedure.tilts_rad = {0.0};
  own.turntable_procedure.eccentricities_m = {0.0};
  own.turntable_procedure.passes = {1};
  return s;
}

double Nominal_rad(const Scenario& s, const Reading& r) {
  return TurntableOf(s).FaceAngle_rad(r.setup, r.position);
}

/// What a reading says of table and face.
double Value_arcsec(const Scenario& s, const Reading& r) {
  return (r.autocollimator_yaw_rad - (r.target_rad - Nominal_rad(s, r))) / arcsec;
}

// The autocollimator reads half the tangent of the doubled angle, and the encoder has its own error at the nulled
// place.
constexpr double kSecondOrder_arcsec = 2e-4;

TEST(PolygonTwin, ReadsTheErrorOfTheTurntableWhereAFaceIsNulledAndThatOfTheFaceWithTheSameSign) {
  Scenario turning = QuietPolygon(), faced = turning;
  TurntableOf(turning).turntable.harmonics = {{Component::kEz, 2.0, 5.0 * arcsec, 0.3}};
  const auto readings = test::RunBench(turning).readings;
  ASSERT_EQ(readings.size(), 36u);
  for (const Reading& r : readings) {
    EXPECT_NEAR(Value_arcsec(turning, r), 5.0 * std::cos(2.0 * Nominal_rad(turning, r) + 0.3), kSecondOrder_arcsec);
    EXPECT_LE(std::abs(r.autocollimator_yaw_rad), 1e-3 * arcsec) << "nulled";
  }
  std::vector<double>& errors_rad = TurntableOf(faced).polygon.face_errors_rad;
  errors_rad.clear();
  for (int face = 0; face < 12; ++face) errors_rad.push_back((3.0 + face) * arcsec);
  for (const Reading& r : test::RunBench(faced).readings) {
    EXPECT_NEAR(r.reference_rad, -30.0 * deg * r.position, 1e-12);
    EXPECT_NEAR(Value_arcsec(faced, r), 3.0 + r.position, kSecondOrder_arcsec);
  }
}

TEST(PolygonTwin, ReadsAFaceThatCannotBeNulledAsItIs) {
  Scenario s = QuietPolygon();
  s.noise_free = false;
  TurntableOf(s).autocollimator.noise_rad = 0.0;
  TurntableOf(s).turntable.repeatability_sd[2] = 2.0 * arcsec;
  int within = 0;
  for (const Reading& r : test::RunBench(s).readings) {
    EXPECT_EQ(r.status, ReadingStatus::kOk);
    within += std::abs(r.autocollimator_yaw_rad) < 1e-3 * arcsec ? 1 : 0;
  }
  EXPECT_LT(within, 5) << "2 arcsec of scatter at every move against a deadband of 0.001";
}

TEST(PolygonTwin, ComesToEveryFaceFromTheSideOfItsPass) {
  Scenario s = QuietPolygon();
  TurntableOf(s).turntable_procedure.passes = {1, -1};
  s.effects = {{"backlash", "", {{"width", 3.0 * arcsec}}, "", {}}};
  const auto readings = test::RunBench(s).readings;
  // Behind by half of the gap: forward too little, backward too much.
  for (const Reading& r : readings) EXPECT_NEAR(Value_arcsec(s, r), -1.5 * r.direction, kSecondOrder_arcsec);
}

TEST(PolygonTwin, ShowsTheEncodersStepsAndNoise) {
  Scenario s = QuietPolygon();
  s.noise_free = false;
  TurntableOf(s).autocollimator.noise_rad = 0.0;
  TurntableOf(s).encoder.step_rad = 0.5 * arcsec;
  for (const Reading& r : test::RunBench(s).readings) {
    const double steps = r.target_rad / (0.5 * arcsec);
    EXPECT_NEAR(steps, std::round(steps), 1e-4);
  }
  TurntableOf(s).encoder = {0.3 * arcsec, 0.0};
  TurntableOf(s).turntable_procedure.passes = {1, 1, 1, 1, 1, 1, 1, 1};
  const auto readings = test::RunBench(s).readings;
  double squares = 0.0;
  for (const Reading& r : readings) squares += std::pow(Value_arcsec(s, r), 2);
  // 288 readings: the deviation of a variance is sqrt(2 / 288), 8 %.
  EXPECT_NEAR(squares / static_cast<double>(readings.size()), 0.09, 4 * 0.08 * 0.09);
}

TEST(PolygonTwin, ShowsThePyramidOfAFaceInY) {
  Scenario s = QuietPolygon();
  TurntableOf(s).polygon.pyramid_rms_rad = 4.0 * arcsec;
  const auto readings = test::RunBench(s).readings;
  double squares = 0.0;
  for (const Reading& r : readings) {
    EXPECT_NEAR(r.autocollimator_tilt_rad, readings[static_cast<std::size_t>(r.position)].autocollimator_tilt_rad,
                kSecondOrder_arcsec * arcsec)
        << "the face's own, in every clamping";
    squares += std::pow(r.autocollimator_tilt_rad / arcsec, 2) / 36.0;
  }
  EXPECT_GT(squares, 4.0);
  EXPECT_LT(squares, 40.0) << "16 from 12 draws";
}

TEST(PolygonTwin, WalksOverItsFacesWhereItIsEccentric) {
  Scenario s = QuietPolygon();
  TurntableOf(s).mirror.width_m = 20e-3;
  TurntableOf(s).mirror.height_m = 20e-3;
  TurntableOf(s).collimator.aperture_m = 10e-3;
  TurntableOf(s).mirror.flatness_m = 100e-9;
  TurntableOf(s).turntable_procedure.eccentricities_m = {1e-3};
  TurntableOf(s).turntable_procedure.tilt_azimuths_rad = {30.0 * deg};
  // 8 h e / H^2 = 2e-6 rad; a hollow face that stands off to the right is met left of its middle and leans to the
  // right.
  for (const Reading& r : test::RunBench(s).readings) {
    const double walk_arcsec = -2e-6 * std::cos(Nominal_rad(s, r) + 30.0 * deg) / arcsec;
    EXPECT_NEAR(Value_arcsec(s, r), walk_arcsec, 0.002) << r.reading;
  }
}

TEST(PolygonTwin, IsFollowed) {
  Scenario s = QuietPolygon();
  TurntableSettings& own = TurntableOf(s);
  own.turntable.harmonics = {{Component::kEx, 2.0, 2.0 * arcsec, 1.0}};
  own.collimator.roll_rad = 5e-3;
  own.mirror.flatness_m = 1e-6;
  own.turntable_procedure.eccentricities_m = {0.1e-3};
  own.turntable_procedure.tilts_rad = {20.0 * arcsec};
  own.turntable_procedure.passes = {1, -1};
  own.turntable.backlash_rad = 3.0 * arcsec;
  s.effects = {{"settling", "", {{"amplitude", 2.0 * arcsec}, {"time_constant", 1.0}}, "", {}},
               {"slip", "x", {{"step", 2.0 * arcsec}, {"at_reading", 20.0}}, "", {}}};
  const test::BenchRun run = test::RunBench(s);
  const auto follow = sim::FollowTurntable(s, run.readings);
  Eigen::VectorXd tilt_rad(std::ssize(run.readings));
  for (Eigen::Index i = 0; i < tilt_rad.size(); ++i) {
    const Reading& r = run.readings[static_cast<std::size_t>(i)];
    const double rotor_rad = r.target_rad - 0.5 * r.direction * own.turntable.backlash_rad;
    tilt_rad[i] = 2.0 * arcsec * std::cos(2.0 * rotor_rad + 1.0);
  }
  const Eigen::MatrixXd predicted_rad = follow->Predict({{"turntable.ex", tilt_rad}});
  for (Eigen::Index i = 0; i < predicted_rad.rows(); ++i) {
    const Reading& r = run.readings[static_cast<std::size_t>(i)];
    EXPECT_NEAR(predicted_rad(i, 0) / arcsec, r.autocollimator_yaw_rad / arcsec, 1e-6) << i;
    EXPECT_NEAR(predicted_rad(i, 1) / arcsec, r.autocollimator_tilt_rad / arcsec, 1e-6) << i;
  }
}

TEST(PolygonTwin, KeepsTheAngleThatIsMeantWhereACompensationIsAtWork) {
  Scenario s = QuietPolygon();
  CompensationTable table;
  for (int k = 0; k < 36; ++k) {
    table.position_rad.push_back(k * 10.0 * deg);
    table.correction_rad.push_back(20.0 * arcsec * std::sin(3.0 * k * 10.0 * deg));
  }
  TurntableOf(s).turntable.compensation = table;
  // The table goes where the correction leads it: that is its error now.
  for (const Reading& r : test::RunBench(s).readings)
    EXPECT_NEAR(Value_arcsec(s, r), table.At(Nominal_rad(s, r)) / arcsec, 0.005)
        << "20 arcsec of 20 arcsec a third of a radian";
}

TEST(PolygonScenario, MayTakeEverySecondFace) {
  EXPECT_NO_THROW(Altered(QuietPolygon(), {"polygon.faces=24"}));
}

}  // namespace
}  // namespace twinbench
