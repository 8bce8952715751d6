#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <set>

#include "tests/diagnose/support/synthetic_run.h"
#include "twin/core/stream.h"
#include "twin/core/units.h"

namespace twinbench::diagnose {
namespace {

using Eigen::Vector4d;
constexpr double kTurn = 2.0 * units::kPi;
const Vector4d kYaw(1, 0, 1, 0), kTilt(0, 1, 0, 1), kLateral(1, 0, -1, 0), kAX(1, 0, 0, 0), kAY(0, 1, 0, 0);

/// An effect, the test that must see it, and what that test must say.
struct EffectCase {
  std::string name;
  std::string test;  // must have p < 0.01
  std::string says;  // part of its reading
  std::function<void(LinearRun&)> add;
  double size_um = kNaN;  // expected effect; NaN: not compared
  double within = 0.3;    // relative: standard uncertainty of sizes near 5 to 10 standard deviations, and shape
  bool free_tables = true;
};

using Course = std::function<double(const Schedule&, int)>;
std::function<void(LinearRun&)> WithPattern(const Vector4d& weight, double size_um, const Course& f) {
  return [=](LinearRun& run) {
    AddEffect(run, size_um * units::um * weight, [&](int i) { return f(run.schedule, i); });
  };
}

double Sense(const Schedule& s, int i) {
  return s.direction[static_cast<std::size_t>(i)];
}
/// From 0 to 1 over the run.
double Along(const Schedule& s, int i) {
  return (s.time_s[i] - s.time_s[0]) / (s.time_s.maxCoeff() - s.time_s[0]);
}

std::vector<EffectCase> CasesOfMotion() {
  const Course cos3_target = [](const Schedule& s, int i) { return std::cos(3.0 * s.target_rad[i]); };
  const Course cos3_reference = [](const Schedule& s, int i) { return std::cos(3.0 * s.reference_rad[i]); };
  const auto in_one_setup = WithPattern(kYaw, 0.5, [=](const Schedule& s, int i) {
    return s.setup[static_cast<std::size_t>(i)] == 1 ? cos3_target(s, i) : 0.0;
  });
  const auto two_waves = [](const Schedule& s, int i) { return Sense(s, i) * std::cos(2.0 * s.target_rad[i]); };
  const auto settling = [](const Schedule& s, int i) { return Sense(s, i) * std::exp(-s.dwell_s[i] / 1.0); };
  const auto creep = [](const Schedule& s, int i) {
    const int start = i - i % 48;  // 12 positions, 4 passes a set-up
    return std::log10(1.0 + (s.time_s[i] - s.time_s[start]) / 60.0);
  };
  const auto sin2 = [](const Schedule& s, int i) { return std::sin(2.0 * s.reference_rad[i]); };
  // From one level to the other in 15 readings.
  const auto bend = [](const Schedule&, int i) { return std::clamp((i - 75) / 15.0, 0.0, 1.0); };
  return {
      {"backlash", "direction: mean", "in yaw: backlash", WithPattern(kYaw, 0.2, Sense), 0.2},
      {"backlash around the turn", "direction: harmonics of the target angle", "order 2",
       WithPattern(kTilt, 0.3, two_waves), 0.3},
      // exp(-0.5) of it is left at the shortest dwell.
      {"settling", "direction: dwell", "in yaw: settling", WithPattern(kYaw, 1.0, settling), 0.61},
      {"wander", "time: wander", "3 half waves over the run in tilt",
       WithPattern(kTilt, 0.3, [](const Schedule& s, int i) { return std::cos(3.0 * units::kPi * Along(s, i)); }),
       0.3},
      {"drift", "time: drift", "in lateral: steady drift", WithPattern(kLateral, 2.0, Along), 2.0},
      {"creep", "time: creep", "in yaw: a mounting that creeps", WithPattern(kYaw, 1.0, creep)},
      {"warm-up", "time: exponential", "since the start of the run",
       WithPattern(kTilt, 2.0, [](const Schedule& s, int i) { return std::exp(-Along(s, i) / 0.1); })},
      {"knock", "time: step", "in yaw: a knock",
       WithPattern(kYaw, 0.6, [](const Schedule&, int i) { return i >= 70 ? 1.0 : 0.0; }), 0.6},
      {"tone", "time: tone", "period 3",
       WithPattern(kAX, 0.3, [](const Schedule& s, int i) { return std::sin(kTurn * s.time_s[i] / 31.0); }), 0.3},
      {"target harmonic", "harmonics: target angle", "order 3 of the target angle in yaw",
       WithPattern(kYaw, 0.2, cos3_target), 0.2, 0.3, false},
      {"reference harmonic", "harmonics: reference angle", "order 2 of the reference angle in tilt",
       WithPattern(kTilt, 0.2, sin2), 0.2, 0.3, false},
      {"target lock", "harmonics by mounting", "synchronous with target", WithPattern(kYaw, 0.2, cos3_target), 0.2, 0.3,
       false},
      {"reference lock", "harmonics by mounting", "synchronous with reference", WithPattern(kYaw, 0.2, cos3_reference), 0.2,
       0.3, false},
      {"interaction", "harmonics by mounting", "synchronous with interaction", in_one_setup, 0.29, 0.3, false},
      {"one phase left", "harmonics by mounting", "that so few mountings cannot show", in_one_setup},
      {"bend", "time: running sum", "the mean of psd_b_y changes near reading 8",
       WithPattern(Vector4d(0, 0, 0, 1), 0.8, bend)},
      {"spike", "outliers", "reading 40 ",
       WithPattern(kAY, 3.0, [](const Schedule&, int i) { return i == 40 ? 1.0 : 0.0; }), 3.0, 0.4}};
}

void AddBodyTemperature(LinearRun& run) {
  const Schedule& s = run.schedule;
  std::vector<double> body = {s.temperature_degC[0]};
  for (int i = 1; i < s.Readings(); ++i) {
    const double part = 1.0 - std::exp(-(s.time_s[i] - s.time_s[i - 1]) / 300.0);
    body.push_back(body.back() + part * (s.temperature_degC[i] - body.back()));
  }
  AddEffect(run, kTilt, [&](int i) { return 10.0 * units::um * body[static_cast<std::size_t>(i)]; });
}

/// Of what the four channels showed before [um].
using Spots_um = Eigen::Map<const Eigen::Matrix4Xd>;
std::function<void(LinearRun&)> OfSpots(const Vector4d& weight, double (*effect_um)(const Vector4d& spots_um)) {
  return [=](LinearRun& run) {
    const Eigen::VectorXd shown_um = run.observed / units::um;
    const Spots_um spots_um(shown_um.data(), 4, shown_um.size() / 4);
    AddEffect(run, weight, [&](int i) { return units::um * effect_um(spots_um.col(i)); });
  };
}

std::vector<double> Drawn_um(const char* name, int count, double sd_um) {
  Stream stream(5, name);
  std::vector<double> values;
  for (int k = 0; k < count; ++k) values.push_back(sd_um * stream.Normal());
  return values;
}

void AddOffsetOfEachPass(LinearRun& run) {
  const auto offset_um = Drawn_um("test.pass", 12, 0.5);
  AddEffect(run, kAX, [&](int i) {
    return units::um * offset_um[static_cast<std::size_t>(run.schedule.pass[static_cast<std::size_t>(i)])];
  });
}

void AddShakingBody(LinearRun& run) {
  const auto shake_um = Drawn_um("test.shake", run.schedule.Readings(), 0.2);
  AddEffect(run, kTilt, [&](int i) { return units::um * shake_um[static_cast<std::size_t>(i)]; });
}

void AddInteraction(LinearRun& run) {
  const auto place_um = Drawn_um("test.place", 36, 0.3);
  AddEffect(run, Vector4d::Ones(), [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    return units::um * place_um[static_cast<std::size_t>(3 * run.schedule.position[k] + run.schedule.setup[k])];
  });
}

/// Student's t with 3 degrees of freedom is a normal deviate over a root of chi-squared.
void MakeTails(LinearRun& run) {
  Stream stream(5, "test.tails");
  for (double& r : run.residual) r *= std::sqrt(3.0 / stream.ChiSquared(3.0));
}

void MakeSpeckle(LinearRun& run) {
  for (int i = 0; i < run.schedule.Readings(); ++i)
    run.residual.segment(4 * i, 2) *= 0.3 + 1.2 * run.observed.segment(4 * i, 2).norm() / (150.0 * units::um);
}

void MakeCorrelated(LinearRun& run) {
  for (int k = 4; k < run.Rows(); ++k) run.residual[k] += 0.4 * run.residual[k - 4];
}

/// More noise on channels from one to another.
std::function<void(LinearRun&)> Louder(int first, int last) {
  return [=](LinearRun& run) {
    for (int k = 0; k < run.Rows(); ++k) run.residual[k] *= k % 4 >= first && k % 4 <= last ? 1.4 : 1.0;
  };
}

std::vector<EffectCase> CasesOfSpotsAndNoise() {
  const auto cubic = [](const Vector4d& u) { return 2.0 * std::pow(u[0] / 150.0, 3); };
  const auto fringes = [](const Vector4d& u) { return 0.25 * std::sin(kTurn * u[0] / 40.0); };
  const auto ghost = [](const Vector4d& u) { return 0.002 * u[0]; };
  const auto dirt = [](const Vector4d& u) { return u[0] > 50.0 && u[1] < -50.0 ? 1.2 : 0.0; };
  return {{"temperature", "temperature", "temperature with a lag of 5 min in tilt", AddBodyTemperature},
          {"detector cubic", "spot: polynomial", "degree 3 of the spot's own coordinate on psd_a_x",
           OfSpots(kAX, cubic)},
          {"fringes", "spot: periodic", "on psd_a_x", OfSpots(kAX, fringes), 0.25, 0.4},
          {"ghost", "channel order", "what psd_a_x showed just before psd_a_y", OfSpots(kAY, ghost), 0.3, 0.4},
          {"dirt", "spot: map", "residual of psd_a_x depends on where the spot stands", OfSpots(kAX, dirt)},
          {"pass offsets", "offsets by pass", "each pass has an offset", AddOffsetOfEachPass, 0.5, 0.6},
          {"shaking body", "channel pattern", "as in tilt", AddShakingBody, 0.2, 0.4},
          {"correlated noise", "whiteness within a pass", "readings 1 apart", MakeCorrelated},
          {"heavy tails", "tails", "Student's t", MakeTails},
          {"noisy channel", "noise of the channels", "psd_b_x", Louder(2, 2)},
          {"noisy detector", "noise of the detectors", "psd_b is", Louder(2, 3)},
          {"speckle", "noise against spot radius", "grows with the distance", MakeSpeckle},
          {"repeatable interaction", "fit to repeats", "the model lacks something repeatable", AddInteraction, 0.3,
           0.5}};
}

std::vector<EffectCase> EffectCases() {
  std::vector<EffectCase> cases = CasesOfMotion();
  std::ranges::move(CasesOfSpotsAndNoise(), std::back_inserter(cases));
  return cases;
}

class ScreenEffect : public testing::TestWithParam<EffectCase> {};

TEST_P(ScreenEffect, IsSeenByItsOwnTestAtItsOwnSize) {
  const EffectCase& c = GetParam();
  LinearRun run = SyntheticRun({.free_tables = c.free_tables});
  AddNoise(run, 4);
  c.add(run);
  const ScreenTest own = Loud(ScreenAsStated(run, 200, 2), c.test, 0.01, c.says);
  if (std::isfinite(c.size_um)) {
    EXPECT_NEAR(own.effect_m / units::um / c.size_um, 1.0, c.within);
  }
}

std::string NameOf(const testing::TestParamInfo<EffectCase>& of) {
  std::string name = of.param.name;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Cases, ScreenEffect, testing::ValuesIn(EffectCases()), NameOf);

/// How many tests other than `own` and those of the overall level are below 0.01.
int LoudOthers(const EffectCase& c, const std::set<std::string>& own, std::uint64_t seed) {
  const std::set<std::string> of_level = {"fit to stated noise", "fit to repeats", "noise of the channels",
                                          "noise of the detectors", "channel pattern"};
  LinearRun run = SyntheticRun({});
  AddNoise(run, seed);
  c.add(run);
  int loud = 0;
  for (const ScreenTest& t : ScreenAsStated(run, 200, seed)) {
    loud += t.p < 0.01 && !own.contains(t.name) && !of_level.contains(t.name);
  }
  return loud;
}

TEST(Screen, DoesNotTakePlainBacklashForSettling) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    LinearRun run = SyntheticRun({});
    AddNoise(run, seed);
    WithPattern(kYaw, 2.0, Sense)(run);
    const std::vector<ScreenTest> tests = ScreenAsStated(run, 100, seed);
    EXPECT_LT(Find(tests, "direction: mean")->p, 1e-6);
    EXPECT_GT(Find(tests, "direction: dwell")->p, 0.005);  // below in 2.5 % of five runs
  }
}

TEST(Screen, SeesARandomWalkInMeansOverManyReadings) {
  LinearRun run = SyntheticRun({.positions = 48});
  AddNoise(run, 1);
  std::vector<double> walk_um = Drawn_um("test.walk", run.schedule.Readings(), 0.1);
  std::partial_sum(walk_um.begin(), walk_um.end(), walk_um.begin());
  AddEffect(run, kAX, [&](int i) { return units::um * walk_um[static_cast<std::size_t>(i)]; });
  const auto tests = ScreenAsStated(run, 200, 1);
  const ScreenTest allan = Loud(tests, "time: Allan deviation", 0.01, "means over 8 readings of psd_a_x");
  // A walk of 0.1 um a step has an Allan deviation of 0.1 um sqrt(8 / 3); free tables and passes take some of it.
  EXPECT_GT(allan.effect_m, 0.08 * units::um);
  EXPECT_LT(allan.effect_m, 0.20 * units::um);
}

TEST(Screen, LeavesUnrelatedTestsSilent) {
  const std::map<std::string, std::set<std::string>> related = {
      {"tone", {"time: tone", "whiteness within a pass", "time: Allan deviation"}},
      {"fringes", {"spot: periodic"}},
      {"ghost", {"channel order", "spot: map"}},
      {"spike", {"outliers", "tails"}}};
  constexpr int kSeeds = 10;
  for (const EffectCase& c : EffectCases()) {
    const auto own = related.find(c.name);
    if (own == related.end()) continue;
    int loud = 0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) loud += LoudOthers(c, own->second, seed);
    // 28 tests in 10 runs at 0.01: 2.8 by chance; some go together, so that 9 is 3 standard deviations.
    EXPECT_LE(loud, 9) << c.name;
  }
}

}  // namespace
}  // namespace twinbench::diagnose
