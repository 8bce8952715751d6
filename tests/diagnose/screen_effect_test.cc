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

TEST(ResidualTests, SeeEachEffectByItsOwnTestAtItsOwnSize) {
  for (const EffectCase& c : EffectCases()) {
    SCOPED_TRACE(c.name);
    LinearRun run = SyntheticRun({.free_tables = c.free_tables});
    AddNoise(run, 4);
    c.add(run);
    const auto tests = TestsAsStated(run, 200, 2);
    const ResidualTest* const own = Find(tests, c.test);
    ASSERT_NE(own, nullptr);
    EXPECT_LT(own->p, 0.001);
    EXPECT_THAT(own->reading, HasSubstr(c.says));
    if (!std::isfinite(c.size_um)) continue;
    EXPECT_NEAR(own->effect_m / units::um / c.size_um, 1.0, c.within);
    EXPECT_THAT(own->reading, AllOf(HasSubstr("; size "), HasSubstr(" um"), HasSubstr(" arcsec)")));
  }
}

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

constexpr int kNullSeeds = 300;

/// Largest distance of the empirical distribution from the uniform one.
double Kolmogorov(std::vector<double> p) {
  std::sort(p.begin(), p.end());
  double distance = 0.0;
  const auto n = static_cast<double>(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    const auto below = static_cast<double>(i);
    distance = std::max({distance, std::abs(p[i] - below / n), std::abs(p[i] - (below + 1.0) / n)});
  }
  return distance;
}

/// The residual tests of many runs of normal noise; `scale` is the true noise over the stated one.
std::vector<std::vector<ResidualTest>> OfNoise(const LinearRun& clean, int seeds, double scale) {
  std::vector<std::vector<ResidualTest>> all;
  for (int seed = 0; seed < seeds; ++seed) {
    LinearRun run = clean;
    AddNoise(run, static_cast<std::uint64_t>(seed));
    run.residual *= scale;
    // Nulls of their own for every run: shared ones would make the p-values depend on each other.
    all.push_back(TestsAsStated(run, 99, 1000 + static_cast<std::uint64_t>(seed)));
  }
  return all;
}

std::map<std::string, std::vector<double>> PValuesOf(const std::vector<std::vector<ResidualTest>>& all) {
  std::map<std::string, std::vector<double>> p;
  for (const auto& tests : all) {
    for (const ResidualTest& t : tests) p[t.name].push_back(t.p);
  }
  return p;
}

void ExpectHonest(const LinearRun& clean) {
  const auto all = OfNoise(clean, kNullSeeds, 1.0);
  for (const auto& [name, values] : PValuesOf(all)) {
    ASSERT_EQ(values.size(), static_cast<std::size_t>(kNullSeeds)) << name;
    // Kolmogorov: sqrt(n) D exceeds 1.95 with probability 0.001. Steps of 1 / 100 in p add at most 0.01.
    EXPECT_LT(Kolmogorov(values), 1.95 / std::sqrt(kNullSeeds) + 0.01) << name;
  }
  const auto alarms = std::ranges::count_if(all, [](const std::vector<ResidualTest>& tests) {
    return std::ranges::any_of(
        tests, [&](const ResidualTest& t) { return t.p < 0.1 / static_cast<double>(tests.size()); });
  });
  // A tenth shared by five tests: 29 of 300 if they are independent, standard deviation 5; 14 and 45 have 0.001.
  EXPECT_GT(alarms, 13);
  EXPECT_LT(alarms, 46);
}

TEST(ResidualTests, HoldTheirPValuesWhereTablesAreFree) {
  const LinearRun clean = SyntheticRun({.positions = 8, .shifts = {0, 1, 3}, .passes = {1, -1, -1, 1}});
  EXPECT_EQ(TestsAsStated(clean, 50, 1).size(), 5u);
  ExpectHonest(clean);
}

TEST(ResidualTests, HoldTheirPValuesInALongSweep) {
  ExpectHonest(SyntheticSweep(240));
}

TEST(ResidualTests, BlameAWrongNoiseFigureOnTheNoiseAndNotOnStructure) {
  constexpr int kFew = 40;
  const LinearRun clean = SyntheticRun({.positions = 8, .shifts = {0, 1, 3}, .passes = {1, -1, -1, 1}});
  for (const auto& [name, values] : PValuesOf(OfNoise(clean, kFew, 1.25))) {
    const auto low = std::count_if(values.begin(), values.end(), [](double v) { return v < 0.01; });
    // 384 rows tell the level to 4 %; the other tests are below 0.01 in 0.4 of 40 runs: 5 has probability 1e-4.
    if (name == "fit to stated noise")
      EXPECT_EQ(low, kFew);
    else
      EXPECT_LT(low, 5) << name;
  }
}

}  // namespace
}  // namespace twinbench::diagnose
