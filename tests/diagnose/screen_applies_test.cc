#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/diagnose/support/synthetic_run.h"
#include "twin/core/units.h"

namespace twinbench::diagnose {
namespace {

using testing::HasSubstr, testing::Not;

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
  EXPECT_EQ(Find(tests, "offsets by mounting"), nullptr);
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
  const ScreenTest speed = Loud(tests, "direction: speed", 0.01, "");
  // Amplitude at 0.3 rad/s; two speeds of 600 readings tell the slope to 1 / sqrt(1200) / (1/3) = 0.09 arcsec.
  EXPECT_NEAR(speed.effect_rad / units::arcsec, 20e-6 * 0.3 / units::arcsec, 0.3);
}

TEST(Screen, FindsTheEccentricityOfADeviceThatHasOnlyAReference) {
  LinearRun run = SyntheticSweep(1200);
  AddNoise(run, 1);
  const Eigen::VectorXd angle_rad = run.schedule.reference_rad;
  AddEffect(run, Eigen::VectorXd::Ones(1), [&](int i) { return 0.5 * units::arcsec * std::cos(angle_rad[i]); });
  const auto tests = ScreenAsStated(run, 200, 1);
  const ScreenTest harmonics = Loud(tests, "harmonics: reference angle", 0.01, "order 1 ");
  // 1200 readings of 1 arcsec: 0.04 arcsec, more where the sweeps cover the turn unevenly.
  EXPECT_NEAR(harmonics.effect_rad / units::arcsec, 0.5, 0.2);
}

TEST(Screen, FindsAHalfTurnOverSeveralTurns) {
  LinearRun run = SyntheticSweep(2400);  // 6 rad and 18 rad a sweep
  AddNoise(run, 1);
  const Eigen::VectorXd angle_rad = run.schedule.reference_rad;
  AddEffect(run, Eigen::VectorXd::Ones(1),
            [&](int i) { return 0.4 * units::arcsec * std::cos(0.42 * angle_rad[i]); });
  Loud(ScreenAsStated(run, 200, 1), "half turns: reference angle", 0.01, "");
}

ScreenTest WithP(const std::string& name, double p) {
  ScreenTest test;
  test.name = name;
  test.p = p;
  test.reading = "reading of " + name;
  return test;
}

TEST(Loud, SharesTheFalseAlarmsAmongTheTests) {
  // 0.01 shared by 4 tests: 0.0025.
  const auto loud = Loud({WithP("a", 0.002), WithP("b", 0.003), WithP("c", 1e-9), WithP("d", 0.5)});
  ASSERT_EQ(loud.size(), 2u);
  EXPECT_EQ(loud[0].name, "c");
  EXPECT_EQ(loud[1].name, "a");
}

TEST(ScreenInWords, TellsTheLoudTestsOrThatThereAreNone) {
  EXPECT_THAT(ScreenInWords({WithP("a", 0.2), WithP("b", 1e-9)}),
              testing::AllOf(HasSubstr("1 of 2 shows"), HasSubstr("reading of b"), Not(HasSubstr("reading of a"))));
  EXPECT_THAT(ScreenInWords({WithP("a", 0.2), WithP("b", 0.1)}), HasSubstr("none of 2"));
}

TEST(Moderated, GivesSizesAsLengthAndAngle) {
  ScreenTest test = WithP("a", 1e-9);
  test.effect_m = 0.31 * units::um;
  test.effect_rad = 0.32 * units::arcsec;
  EXPECT_THAT(Moderated({test}).front().reading, HasSubstr("size 0.31 um (0.32 arcsec)"));
  test.effect_m = kNaN;
  EXPECT_THAT(Moderated({test}).front().reading, HasSubstr("size 0.32 arcsec"));
  test.p = 0.2;
  EXPECT_THAT(Moderated({test}).front().reading, HasSubstr("not beyond noise"));
}

TEST(Screen, SizesWhatItFindsInMicrometresAndArcseconds) {
  LinearRun run = SyntheticRun({});
  AddNoise(run, 1);
  // 0.2 m a radian in yaw: 1 um on psd_a_x is as much as 5 urad or 1.03 arcsec of yaw.
  AddEffect(run, Eigen::Vector4d(1, 0, 0, 0), [&](int i) { return i >= 70 ? 1.0 * units::um : 0.0; });
  const ScreenTest step = Loud(ScreenAsStated(run, 100, 1), "time: step", 0.01, " um (");
  EXPECT_NEAR(step.effect_rad / step.effect_m, 1.0 / 0.2, 1e-9);
  EXPECT_THAT(step.reading, HasSubstr(" arcsec)"));
}

TEST(Screen, GivesNoLengthWhereReadingsAreAngles) {
  LinearRun run = SyntheticSweep(400);
  AddNoise(run, 1);
  for (const ScreenTest& test : ScreenAsStated(run, 60, 1)) {
    EXPECT_TRUE(std::isnan(test.effect_m)) << test.name;
    EXPECT_THAT(test.reading, Not(HasSubstr(" um"))) << test.name;
  }
}

}  // namespace
}  // namespace twinbench::diagnose
