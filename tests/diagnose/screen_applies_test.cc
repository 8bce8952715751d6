#include <gtest/gtest.h>

#include <cmath>

#include "tests/diagnose/support/synthetic_run.h"
#include "twin/core/units.h"

namespace twinbench::diagnose {
namespace {

constexpr int kNulls = 60;

TEST(Screen, LeavesOutTemperatureWhereNoneWasRecorded) {
  LinearRun run = SyntheticRun({});
  AddNoise(run, 1);
  run.schedule.temperature_degC.setConstant(kNaN);
  const auto tests = ScreenAsStated(run, kNulls, 1);
  EXPECT_EQ(Find(tests, "temperature"), nullptr);
  EXPECT_EQ(Find(tests, "temperature rate"), nullptr);
}

TEST(Screen, LeavesOutDirectionIfThereIsOnlyOne) {
  LinearRun run = SyntheticRun({.passes = {1, 1}});
  AddNoise(run, 1);
  for (const ScreenTest& t : ScreenAsStated(run, kNulls, 1)) EXPECT_NE(t.name.substr(0, 9), "direction") << t.name;
}

TEST(Screen, LeavesOutTheStatedNoiseIfItWasEstimatedFromTheData) {
  LinearRun run = SyntheticRun({});
  AddNoise(run, 1);
  run.sigma_stated = false;
  EXPECT_EQ(Find(ScreenAsStated(run, kNulls, 1), "fit to stated noise"), nullptr);
}

TEST(Screen, LeavesOutHarmonicsThatTheFreeTablesAbsorb) {
  LinearRun run = SyntheticRun({});
  AddNoise(run, 1);
  const auto tests = ScreenAsStated(run, kNulls, 1);
  EXPECT_EQ(Find(tests, "harmonics: target angle"), nullptr);
  EXPECT_EQ(Find(tests, "harmonics: reference angle"), nullptr);
  EXPECT_EQ(Find(tests, "offsets by set-up"), nullptr);
}

TEST(Screen, NeverHoldsATestWithoutStatisticOrPValue) {
  LinearRun run = SyntheticRun({}), sweep = SyntheticSweep(400);
  AddNoise(run, 1);
  AddNoise(sweep, 1);
  for (const LinearRun& r : {run, sweep, SyntheticRun({}), SyntheticSweep(400)}) {  // the last two without noise
    for (const ScreenTest& t : ScreenAsStated(r, kNulls, 1)) {
      EXPECT_TRUE(std::isfinite(t.statistic)) << t.name;
      EXPECT_GT(t.p, 0.0) << t.name;
      EXPECT_LE(t.p, 1.0) << t.name;
      EXPECT_FALSE(t.reading.empty()) << t.name;
    }
  }
}

TEST(Screen, TellsLatencyFromBacklashOnAnAngleBenchInMotion) {
  LinearRun run = SyntheticSweep(1200);
  AddNoise(run, 1);
  const Eigen::VectorXd velocity = run.schedule.velocity_rad_s;
  // 20 us at 0.1 and 0.3 rad/s: 0.4 and 1.2 arcsec.
  AddEffect(run, Eigen::VectorXd::Ones(1), [&](int i) { return 20e-6 * velocity[i]; });
  const auto tests = ScreenAsStated(run, 200, 1);
  const ScreenTest* speed = Find(tests, "direction: speed");
  ASSERT_NE(speed, nullptr);
  EXPECT_LT(speed->p, 0.01);
  // Amplitude at 0.3 rad/s; two speeds of 600 readings tell the slope to 1 / sqrt(1200) / (1/3) = 0.09 arcsec.
  EXPECT_NEAR(speed->effect_rad / units::arcsec, 20e-6 * 0.3 / units::arcsec, 0.3);
}

TEST(Screen, FindsTheEccentricityOfADeviceThatHasOnlyAReference) {
  LinearRun run = SyntheticSweep(1200);
  AddNoise(run, 1);
  const Eigen::VectorXd angle_rad = run.schedule.reference_rad;
  AddEffect(run, Eigen::VectorXd::Ones(1), [&](int i) { return 0.5 * units::arcsec * std::cos(angle_rad[i]); });
  const auto tests = ScreenAsStated(run, 200, 1);
  const ScreenTest* harmonics = Find(tests, "harmonics: reference angle");
  ASSERT_NE(harmonics, nullptr);
  EXPECT_LT(harmonics->p, 0.01);
  EXPECT_NE(harmonics->reading.find("order 1 "), std::string::npos) << harmonics->reading;
  // 1200 readings of 1 arcsec: 0.04 arcsec, more where the sweeps cover the turn unevenly.
  EXPECT_NEAR(harmonics->effect_rad / units::arcsec, 0.5, 0.2);
}

TEST(Screen, FindsAHalfTurnOverSeveralTurns) {
  LinearRun run = SyntheticSweep(2400);  // 6 rad and 18 rad a sweep
  AddNoise(run, 1);
  const Eigen::VectorXd angle_rad = run.schedule.reference_rad;
  AddEffect(run, Eigen::VectorXd::Ones(1),
            [&](int i) { return 0.4 * units::arcsec * std::cos(0.42 * angle_rad[i]); });
  const auto tests = ScreenAsStated(run, 200, 1);
  const ScreenTest* half = Find(tests, "half turns: reference angle");
  ASSERT_NE(half, nullptr);
  EXPECT_LT(half->p, 0.01);
}

}  // namespace
}  // namespace twinbench::diagnose
