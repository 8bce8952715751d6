#include "twin/benches/rotary_4dof/estimators/stability.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/measure/bench.h"

namespace twinbench::measure {
namespace {

const Vector4 kStep(2 * units::arcsec, -1 * units::arcsec, 3 * units::arcsec, 0.5 * units::um);
const Vector4 kNoise(0.3 * units::arcsec, 0.2 * units::arcsec, 0.9 * units::arcsec, 0.1 * units::um);

Motion At(double time_s, ReadingStatus status) {
  Motion m;
  m.phase = Phase::kStability;
  m.status = status;
  m.time = Time(FromSeconds(time_s));
  return m;
}

/// A motion of `factor` steps at `time_s`, read with `kNoise`.
Motion Resting(double factor, double time_s) {
  Motion m = At(time_s, ReadingStatus::kOk);
  m.SetValues(factor * kStep);
  m.cov = kNoise.cwiseAbs2().asDiagonal();
  return m;
}

Motion Lost(double time_s) {
  return At(time_s, ReadingStatus::kNoLight);
}

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
