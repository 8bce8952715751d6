#include "tests/measure/bench.h"
#include "twin/benches/rotary_4dof/estimators/stability.h"
#include "twin/benches/rotary_4dof/estimators/verification.h"

namespace twinbench::measure {
namespace {

struct Record {
  std::vector<Motion> motions;
  std::vector<Reading> readings;
};

/// Adds a stop where the bench reads `extra` more than the autocollimator, which shows `shown_rad` on both axes.
void Add(Record& record, double shown_rad, const Eigen::Vector2d& extra_rad) {
  Reading r{.phase = Phase::kVerification, .autocollimator_yaw_rad = shown_rad,
            .autocollimator_tilt_rad = shown_rad};
  Motion m{.phase = r.phase, .status = ReadingStatus::kOk};
  m.SetValues({shown_rad + extra_rad[0], shown_rad + extra_rad[1], 0.0, 0.0});
  m.cov = Vector4(9e-14, 1e-14, 0.0, 0.0).asDiagonal();
  m.cov_systematic = Vector4(16e-14, 3e-14, 0.0, 0.0).asDiagonal();
  record.readings.push_back(r);
  record.motions.push_back(m);
}

/// Differences of -2, 0, +2 (yaw) and 0, 0, 3 (tilt) microradian on top of mounting constants.
Record ThreeStops(const Eigen::Vector2d& mount_rad = Eigen::Vector2d::Zero()) {
  Record record;
  Add(record, -1e-4, mount_rad + 1e-6 * Eigen::Vector2d(-2, 0));
  Add(record, 0.0, mount_rad + 1e-6 * Eigen::Vector2d(0, 0));
  Add(record, 1e-4, mount_rad + 1e-6 * Eigen::Vector2d(2, 3));
  return record;
}

Verification Summarise(const Record& record) { return SummariseVerification(record.motions, record.readings, 1.0); }

TEST(SummariseVerification, HasTheClosedFormsOfThreeStops) {
  const Verification v = Summarise(ThreeStops());
  EXPECT_EQ(v.readings, 3);
  const double tolerance = 1e-18;               // rounding of 1e-4 rad, squared in, rooted out
  EXPECT_NEAR(v.rms_yaw_rad, 2e-6, tolerance);  // sqrt((4 + 0 + 4) / 2)
  EXPECT_NEAR(v.max_yaw_rad, 2e-6, tolerance);
  EXPECT_NEAR(v.rms_tilt_rad, std::sqrt(3.0) * 1e-6, tolerance);  // -1, -1, 2 about the mean
  EXPECT_NEAR(v.max_tilt_rad, 2e-6, tolerance);
  EXPECT_NEAR(v.u_yaw_rad, 5e-7, tolerance);  // noise 0.3 and calibration 0.4 microradian
  EXPECT_NEAR(v.u_tilt_rad, 2e-7, tolerance);
}

TEST(SummariseVerification, TakesTheMountingOffFirst) {
  const Verification plain = Summarise(ThreeStops()), mounted = Summarise(ThreeStops({3e-4, -2e-4}));
  EXPECT_NEAR(mounted.rms_yaw_rad, plain.rms_yaw_rad, 1e-18);  // rounding
  EXPECT_NEAR(mounted.max_tilt_rad, plain.max_tilt_rad, 1e-18);
}

TEST(SummariseVerification, LeavesOutWhatHasNoTwoSides) {
  Record record = ThreeStops();
  for (int k = 0; k < 3; ++k) Add(record, 0.0, {1.0, 1.0});
  record.motions[3].status = ReadingStatus::kClippedSpot;
  record.readings[4].autocollimator_tilt_rad = kNaN;
  record.motions[5].phase = Phase::kCalibration;
  const Verification v = Summarise(record);
  EXPECT_EQ(v.readings, 3);
  EXPECT_EQ(v.rms_yaw_rad, Summarise(ThreeStops()).rms_yaw_rad);
}

TEST(SummariseVerification, HasNoNumbersWithFewerThanTwoReadingsAndRefusesThoseOfOtherMotions) {
  Record record;
  Add(record, 0.0, {0.0, 0.0});
  const Verification v = Summarise(record);
  EXPECT_EQ(v.readings, 1);
  EXPECT_TRUE(std::isnan(v.rms_yaw_rad) && std::isnan(v.max_tilt_rad) && std::isnan(v.u_yaw_rad));
  EXPECT_THROW(SummariseVerification(ThreeStops().motions, {}, 1.0), std::logic_error);
}

const Vector4 kStep(2 * units::arcsec, -1 * units::arcsec, 3 * units::arcsec, 0.5 * units::um);
const Vector4 kNoise(0.3 * units::arcsec, 0.2 * units::arcsec, 0.9 * units::arcsec, 0.1 * units::um);

Motion At(double time_s, ReadingStatus status) {
  return {.phase = Phase::kStability, .time = Time(FromSeconds(time_s)), .status = status};
}

/// A motion of `factor` steps at `time_s`, read with `kNoise`.
Motion Resting(double factor, double time_s) {
  Motion m = At(time_s, ReadingStatus::kOk);
  m.SetValues(factor * kStep);
  m.cov = kNoise.cwiseAbs2().asDiagonal();
  return m;
}

Motion Lost(double time_s) { return At(time_s, ReadingStatus::kNoLight); }

void ExpectRelative(const Vector4& found, const Vector4& expected) {
  EXPECT_LT((found.cwiseQuotient(expected) - Vector4::Ones()).cwiseAbs().maxCoeff(), 1e-12);  // rounding
}

TEST(SummariseStability, HasTheClosedFormsOfARamp) {
  const auto s = SummariseStability({Resting(0, 5), Resting(1, 15), Resting(2, 25), Resting(3, 35)}, Bench());
  EXPECT_EQ(s.readings, 4);
  EXPECT_EQ(s.left_out, 0);
  EXPECT_DOUBLE_EQ(s.duration_s, 30.0);
  ExpectRelative(s.range, 3.0 * kStep.cwiseAbs());
  // 0, 1, 2, 3 about 1.5: squares 5, divided by 4 - 1; its own uncertainty is a part 1 / sqrt(2 (n - 1)).
  ExpectRelative(s.deviation, std::sqrt(5.0 / 3.0) * kStep.cwiseAbs());
  ExpectRelative(s.u_deviation, std::sqrt(5.0 / 18.0) * kStep.cwiseAbs());
}

TEST(SummariseStability, SaysWhatTheReadingsOwnNoiseExplains) {
  auto motions = std::vector<Motion>{Resting(0, 0), Resting(1, 1)};
  ExpectRelative(SummariseStability(motions, Bench()).noise, kNoise);
  motions[1].cov *= 9.0;  // variances are averaged: (1 + 9) / 2
  ExpectRelative(SummariseStability(motions, Bench()).noise, std::sqrt(5.0) * kNoise);
}

TEST(SummariseStability, CountsButDoesNotUseReadingsWithoutNumbers) {
  const auto all = SummariseStability({Resting(0, 0), Resting(2, 10)}, Bench());
  const auto some = SummariseStability({Lost(-5), Resting(0, 0), Lost(5), Resting(2, 10), Lost(15)}, Bench());
  EXPECT_EQ(some.readings, 2);
  EXPECT_EQ(some.left_out, 3);
  EXPECT_EQ(some.range, all.range);
  EXPECT_EQ(some.duration_s, all.duration_s);
}

TEST(SummariseStability, LooksAtNoOtherPhase) {
  std::vector<Motion> motions = {Resting(0, 0), Resting(1, 1), Resting(100, 2), Lost(3)};
  motions[2].phase = motions[3].phase = Phase::kFullCircle;
  const auto s = SummariseStability(motions, Bench());
  EXPECT_EQ(s.readings, 2);
  EXPECT_EQ(s.left_out, 0);
  ExpectRelative(s.range, kStep.cwiseAbs());
}

TEST(SummariseStability, HasNoNumbersWithFewerThanTwoReadings) {
  const auto s = SummariseStability({Resting(1, 0), Lost(1)}, Bench());
  EXPECT_EQ(s.readings, 1);
  EXPECT_EQ(s.left_out, 1);
  EXPECT_TRUE(std::isnan(s.duration_s) && std::isnan(s.wavelength_range_m));
  EXPECT_TRUE(s.range.array().isNaN().all() && s.deviation.array().isNaN().all() && s.noise.array().isNaN().all());
}

/// Apparent motion when light of another wavelength falls on the resting bench: both orders leave at asin(lambda
/// rho), while the PSDs stand where the nominal orders go.
Vector4 MotionSeen(double wavelength_m) {
  const BenchGeometry bench = Bench();
  const double turn_rad = std::asin(wavelength_m * bench.lines_per_m) - std::asin(bench.SinTheta());
  const double u_m = bench.psd_distance_m[0] * std::tan(turn_rad);
  return SolveMotion(Vector4(u_m, 0.0, -u_m, 0.0), bench).motion;
}

TEST(SummariseStability, NamesTheChangeOfWavelengthThatWouldLookLikeTheShift) {
  std::vector<Motion> motions = {Resting(0, 0), Resting(0, 1)};
  const double change_m = 2e-12;
  motions[1].SetValues(MotionSeen(Bench().wavelength_m + change_m));
  // First order of 3e-6 relative; no angle changes beside the shift.
  EXPECT_NEAR(SummariseStability(motions, Bench()).wavelength_range_m / change_m, 1.0, 1e-4);
}

}  // namespace
}  // namespace twinbench::measure
