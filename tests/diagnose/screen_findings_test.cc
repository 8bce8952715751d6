#include <gmock/gmock.h>

#include "tests/diagnose/support/synthetic_run.h"
#include "twin/core/units.h"

namespace twinbench::diagnose {
namespace {

using testing::HasSubstr;
using testing::Not;

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
  const auto tests = ScreenAsStated(run, 100, 1);
  const ScreenTest* step = Find(tests, "time: step");
  ASSERT_NE(step, nullptr);
  EXPECT_NEAR(step->effect_rad / step->effect_m, 1.0 / 0.2, 1e-9);
  EXPECT_THAT(step->reading, testing::AllOf(HasSubstr(" um ("), HasSubstr(" arcsec)")));
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
