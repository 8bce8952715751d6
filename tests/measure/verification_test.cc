#include "twin/benches/rotary_4dof/estimators/verification.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/measure/bench.h"

namespace twinbench::measure {
namespace {

struct Record {
  std::vector<Motion> motions;
  std::vector<Reading> readings;
};

/// Adds a stop where the bench reads `extra` more than the autocollimator, which shows `shown_rad` on both axes.
void Add(Record& record, double shown_rad, const Eigen::Vector2d& extra_rad) {
  Reading r;
  r.phase = Phase::kVerification;
  r.autocollimator_yaw_rad = r.autocollimator_tilt_rad = shown_rad;
  Motion m;
  m.phase = r.phase;
  m.status = ReadingStatus::kOk;
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

Verification Summarise(const Record& record) {
  return SummariseVerification(record.motions, record.readings, 1.0);
}

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

TEST(SummariseVerification, FindsTheScaleErrorOfAWrongDistance) {
  // What the published estimator does: readings 13.27 % too large over a sweep of +-300 arcsec.
  Record record;
  double squares = 0.0;
  for (int k = -6; k <= 6; ++k) {
    const double angle_rad = 50.0 * units::arcsec * k, extra_rad = 0.1327 * angle_rad;
    Add(record, angle_rad, {extra_rad, 0.0});
    squares += extra_rad * extra_rad;
  }
  EXPECT_NEAR(Summarise(record).rms_yaw_rad, std::sqrt(squares / 12.0), 1e-16);  // rounding
  EXPECT_NEAR(Summarise(record).max_yaw_rad, 0.1327 * 300 * units::arcsec, 1e-16);
}

}  // namespace
}  // namespace twinbench::measure
