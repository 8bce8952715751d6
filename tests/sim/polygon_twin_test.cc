#include "tests/support/angle_benches.h"
#include "twin/benches/turntable_autocollimator/twin/twin.h"

// A polygon on the turntable: each face is nulled by turning the table, and the encoder is read.
namespace twinbench {
namespace {

using units::arcsec, units::deg;

/// Twelve faces without errors, three clampings, without noise.
Scenario QuietPolygon(const std::vector<std::string>& but = {}) {
  return ParseScenario("bench = \"turntable_autocollimator\"\nnoise_free = true\npolygon.faces = 12\n"
                       "autocollimator.deadband_arcsec = 0.001\n[turntable_procedure]\nphases = [\"full_circle\"]\npositions = 12\n"
                       "polygon_offsets_deg = [0.0, 17.0, 250.0]\ntilts_arcsec = [0.0]\neccentricities_um = [0.0]\npasses = [1]\n",
                       "quiet.toml", "", but);
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
  EXPECT_NO_THROW(QuietPolygon({"polygon.faces=24"})) << "every second one may be taken";
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
  const Scenario s = QuietPolygon({"noise_free=false", "autocollimator.noise_arcsec=0", "turntable.repeatability.ez_arcsec=2"});
  int within = 0;
  for (const Reading& r : test::RunBench(s).readings) {
    EXPECT_EQ(r.status, ReadingStatus::kOk);
    within += std::abs(r.autocollimator_yaw_rad) < 1e-3 * arcsec ? 1 : 0;
  }
  EXPECT_LT(within, 5) << "2 arcsec of scatter at every move against a deadband of 0.001";
}

TEST(PolygonTwin, ComesToEveryFaceFromTheSideOfItsPass) {
  const Scenario s = QuietPolygon({"turntable_procedure.passes=[1, -1]", "effect=[{name=\"backlash\", width_arcsec=3}]"});
  const auto readings = test::RunBench(s).readings;
  // Behind by half of the gap: forward too little, backward too much.
  for (const Reading& r : readings) EXPECT_NEAR(Value_arcsec(s, r), -1.5 * r.direction, kSecondOrder_arcsec);
}

TEST(PolygonTwin, ShowsTheEncodersStepsAndNoise) {
  Scenario s = QuietPolygon({"noise_free=false", "autocollimator.noise_arcsec=0", "encoder.step_arcsec=0.5"});
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
  const auto readings = test::RunBench(QuietPolygon({"polygon.pyramid_rms_arcsec=4"})).readings;
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
  const Scenario s = QuietPolygon({"mirror.width_mm=20", "mirror.height_mm=20", "mirror.flatness_nm=100", "autocollimator.aperture_mm=10",
                                   "turntable_procedure.eccentricities_um=[1000]", "turntable_procedure.tilt_azimuths_deg=[30]"});
  // 8 h e / H^2 = 2e-6 rad; a hollow face that stands off to the right is met left of its middle and leans to the
  // right.
  for (const Reading& r : test::RunBench(s).readings) {
    const double walk_arcsec = -2e-6 * std::cos(Nominal_rad(s, r) + 30.0 * deg) / arcsec;
    EXPECT_NEAR(Value_arcsec(s, r), walk_arcsec, 0.002) << r.reading;
  }
}

TEST(PolygonTwin, IsFollowed) {
  Scenario s = QuietPolygon(
      {"autocollimator.roll_mrad=5", "mirror.flatness_nm=1000", "turntable_procedure.eccentricities_um=[100]",
       "turntable.backlash_arcsec=3", "turntable_procedure.tilts_arcsec=[20]", "turntable_procedure.passes=[1, -1]",
       "effect=[{name=\"settling\", amplitude_arcsec=2, time_constant_s=1}, {name=\"slip\", where=\"x\", step_arcsec=2, at_reading=20}]"});
  TurntableOf(s).turntable.harmonics = {{Component::kEx, 2.0, 2.0 * arcsec, 1.0}};
  const test::BenchRun run = test::RunBench(s);
  const auto follow = sim::FollowTurntable(s, run.readings);
  Eigen::VectorXd tilt_rad(std::ssize(run.readings));
  for (Eigen::Index i = 0; i < tilt_rad.size(); ++i) {
    const Reading& r = run.readings[static_cast<std::size_t>(i)];
    const double rotor_rad = r.target_rad - 0.5 * r.direction * TurntableOf(s).turntable.backlash_rad;
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

}  // namespace
}  // namespace twinbench
