#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/diagnose/support/synthetic_run.h"
#include "twin/core/stream.h"
#include "twin/core/units.h"

namespace twinbench::diagnose {
namespace {

using Eigen::Vector4d;
using testing::AllOf, testing::HasSubstr, testing::Not;

/// An effect, the test that must see it, and what that test must say.
struct EffectCase {
  std::string name;
  std::string test;  // must have p < 0.001
  std::string says;  // part of its reading
  std::function<void(LinearRun&)> add;
  double size_um = kNaN;  // expected effect; NaN: it has none
  double within = 0.3;    // relative: standard uncertainty of sizes near 5 to 10 standard deviations, and shape
  bool free_tables = true;
};

/// Of a size in um, as f of the course and the reading.
std::function<void(LinearRun&)> On(const Vector4d& channels, double size_um, double (*f)(const Schedule&, int)) {
  return [=](LinearRun& run) {
    AddEffect(run, size_um * units::um * channels, [&](int i) { return f(run.schedule, i); });
  };
}

/// Scales the noise of the rows for which it holds.
std::function<void(LinearRun&)> Louder(double ratio, bool (*where)(const LinearRun&, int row)) {
  return [=](LinearRun& run) {
    for (int k = 0; k < run.Rows(); ++k) run.residual[k] *= where(run, k) ? ratio : 1.0;
  };
}

void MakeCorrelated(LinearRun& run) {
  for (int k = 4; k < run.Rows(); ++k) run.residual[k] += 0.4 * run.residual[k - 4];
}

/// Student's t with three degrees of freedom.
void MakeTails(LinearRun& run) {
  Stream stream(3, "test.tails");
  for (double& v : run.residual) v /= std::sqrt(stream.ChiSquared(3.0) / 3.0);
}

int PassOf(const LinearRun& run, int row) {
  return run.schedule.pass[static_cast<std::size_t>(run.ReadingOf(row))];
}

std::vector<EffectCase> EffectCases() {
  const auto sense = [](const Schedule& s, int i) {
    return static_cast<double>(s.direction[static_cast<std::size_t>(i)]);
  };
  const auto step = [](const Schedule&, int i) { return i >= 70 ? 1.0 : 0.0; };
  const auto alternating = [](const Schedule&, int i) { return i % 2 == 0 ? 1.0 : -1.0; };
  const auto hum = [](const Schedule& s, int i) { return std::sin(units::turn * s.time_s[i] / 31.0); };
  const auto order3 = [](const Schedule& s, int i) { return std::cos(3.0 * s.target_rad[i]); };
  const auto spike = [](const Schedule&, int i) { return i == 40 ? 1.0 : 0.0; };
  return {
      {"too much noise", "fit to stated noise", "1.2", Louder(1.25, [](const LinearRun&, int) { return true; })},
      {"too little noise", "fit to stated noise", "the noise figure is too large",
       Louder(0.8, [](const LinearRun&, int) { return true; })},
      {"backlash", "runs and autocorrelation", "psd_a_x", On(Vector4d(1, 0, 0, 0), 0.35, sense)},
      {"knock", "runs and autocorrelation", "psd_a_y", On(Vector4d(0, 1, 0, 0), 0.8, step)},
      {"alternation", "runs and autocorrelation", "psd_b_x", On(Vector4d(0, 0, 1, 0), 0.3, alternating)},
      {"correlated noise", "runs and autocorrelation", "fewer and longer", MakeCorrelated},
      {"tone", "periodogram", "psd_a_x follows a wave of 32", On(Vector4d(1, 0, 0, 0), 0.3, hum), 0.3},
      {"harmonic", "periodogram", "psd_b_y follows order 3 of the target angle",
       On(Vector4d(0, 0, 0, 1), 0.3, order3), 0.3, 0.3, false},
      {"spike", "normality", "farthest is reading 40 ", On(Vector4d(0, 1, 0, 0), 3.0, spike), 3.0, 0.4},
      {"heavy tails", "normality", "outliers, spikes", MakeTails},
      // 1.7 times 0.3 um is 0.41 um beside it.
      {"noisy channel", "variance by group", "by channel: psd_b_x has 1.",
       Louder(1.7, [](const LinearRun& run, int row) { return run.ChannelOf(row) == 2; }), 0.41, 0.3},
      {"noisy mounting", "variance by group", "by mounting: mounting 1 has 1.",
       Louder(1.6, [](const LinearRun& run, int row) { return PassOf(run, row) / 4 == 1; })},
      {"noisy pass", "variance by group", "by pass: pass 5 has 1.",
       Louder(1.8, [](const LinearRun& run, int row) { return PassOf(run, row) == 5; })},
      {"noisy direction", "variance by group", "by direction: backward has 1.",
       Louder(1.6,
              [](const LinearRun& run, int row) {
                return run.schedule.direction[static_cast<std::size_t>(run.ReadingOf(row))] < 0;
              })},
      {"noisy place", "variance by group", "by measuring position: measuring position 7 has 2.",
       Louder(2.5, [](const LinearRun& run, int row) {
         return run.schedule.position[static_cast<std::size_t>(run.ReadingOf(row))] == 7;
       })}};
}

class ResidualTestOf : public testing::TestWithParam<EffectCase> {};

TEST_P(ResidualTestOf, IsSeenByItsOwnTestAtItsOwnSize) {
  const EffectCase& c = GetParam();
  LinearRun run = SyntheticRun({.free_tables = c.free_tables});
  AddNoise(run, 4);
  c.add(run);
  const auto tests = TestsAsStated(run, 200, 2);
  const ResidualTest* const own = Find(tests, c.test);
  ASSERT_NE(own, nullptr);
  EXPECT_LT(own->p, 0.001);
  EXPECT_THAT(own->reading, HasSubstr(c.says));
  if (std::isfinite(c.size_um)) {
    EXPECT_NEAR(own->effect_m / units::um / c.size_um, 1.0, c.within);
    EXPECT_THAT(own->reading, AllOf(HasSubstr("; size "), HasSubstr(" um"), HasSubstr(" arcsec)")));
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, ResidualTestOf, testing::ValuesIn(EffectCases()), [](const auto& of) {
  std::string name = of.param.name;
  std::ranges::replace(name, ' ', '_');
  return name;
});

TEST(Periodogram, FindsATurnAndAHalfOfAnAngleBenchInMotion) {
  LinearRun run = SyntheticSweep(2400);
  AddNoise(run, 1);
  const Eigen::VectorXd angle_rad = run.schedule.reference_rad;
  AddEffect(run, Eigen::VectorXd::Ones(1),
            [&](int i) { return 0.4 * units::arcsec * std::cos(1.5 * angle_rad[i]); });
  const auto tests = TestsAsStated(run, 100, 1);
  const ResidualTest* const own = Find(tests, "periodogram");
  EXPECT_THAT(own->reading, HasSubstr("order 1.5 of the reference angle"));
  // 2400 readings of 1 arcsec: 0.03 arcsec.
  EXPECT_NEAR(own->effect_rad / units::arcsec, 0.4, 0.1);
  EXPECT_TRUE(std::isnan(own->effect_m)) << "readings are angles";
  EXPECT_THAT(own->reading, Not(HasSubstr(" um")));
}

TEST(ResidualTests, LeaveOutStatedNoiseThatWasEstimatedFromTheData) {
  LinearRun run = SyntheticRun({});
  AddNoise(run, 1);
  run.sigma_stated = false;
  EXPECT_EQ(Find(TestsAsStated(run, 60, 1), "fit to stated noise"), nullptr);
}

TEST(ResidualTests, SortNothingByWhatIsTheSameAllOverARun) {
  LinearRun run = SyntheticSweep(400);
  run.schedule.direction.assign(400, 1);
  run.schedule.pass.assign(400, 0);
  AddNoise(run, 1);
  EXPECT_EQ(Find(TestsAsStated(run, 60, 1), "variance by group"), nullptr);
}

TEST(ResidualTests, AlwaysHaveAStatisticAPValueAndWords) {
  LinearRun run = SyntheticRun({}), sweep = SyntheticSweep(400), untimed = SyntheticSweep(400);
  untimed.schedule.time_s.setConstant(kNaN);
  for (LinearRun* r : {&run, &sweep, &untimed}) AddNoise(*r, 1);
  for (const LinearRun& r : {run, sweep, untimed, SyntheticRun({}), SyntheticSweep(400)}) {  // two without noise
    for (const ResidualTest& t : TestsAsStated(r, 60, 1)) {
      EXPECT_TRUE(std::isfinite(t.statistic)) << t.name;
      EXPECT_GT(t.p, 0.0) << t.name;
      EXPECT_LE(t.p, 1.0) << t.name;
      EXPECT_FALSE(t.reading.empty()) << t.name;
      EXPECT_FALSE(t.tables.empty()) << t.name;
    }
  }
}

ResidualTest WithP(const std::string& name, double p) {
  ResidualTest test;
  test.name = name;
  test.p = p;
  test.reading = "reading of " + name;
  return test;
}

TEST(StandingOut, SharesTheFalseAlarmsAmongTheTests) {
  // 0.01 shared by 4 tests: 0.0025.
  const auto out = StandingOut({WithP("a", 0.002), WithP("b", 0.003), WithP("c", 1e-9), WithP("d", 0.5)});
  ASSERT_EQ(out.size(), 2u);
  EXPECT_EQ(out[0].name, "c");
  EXPECT_EQ(out[1].name, "a");
}

TEST(ResidualTestsInWords, TellThoseThatStandOutOrThatThereAreNone) {
  EXPECT_THAT(ResidualTestsInWords({WithP("a", 0.2), WithP("b", 1e-9)}),
              AllOf(HasSubstr("1 of 2 shows"), HasSubstr("reading of b"), Not(HasSubstr("reading of a"))));
  EXPECT_THAT(ResidualTestsInWords({WithP("a", 0.2), WithP("b", 0.1)}), HasSubstr("none of 2"));
}

}  // namespace
}  // namespace twinbench::diagnose
