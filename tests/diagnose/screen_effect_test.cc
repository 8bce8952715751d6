#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
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
  std::string test;      // must have p < 0.01
  std::string says;      // part of its reading
  double size_m = kNaN;  // expected effect_m; NaN: not compared
  double within = 0.3;   // relative: standard uncertainty of sizes near 5 to 10 standard deviations, and shape
  std::function<void(LinearRun&)> add;
  bool free_tables = true;
};

double At(const Eigen::VectorXd& v, int reading) {
  return v[reading];
}

std::vector<EffectCase> Cases() {
  const auto pattern = [](const Vector4d& weight, double size_m, std::function<double(const Schedule&, int)> f) {
    return [=](LinearRun& run) { AddEffect(run, weight, [&](int i) { return size_m * f(run.schedule, i); }); };
  };
  const auto duration = [](const Schedule& s) { return s.time_s.maxCoeff() - s.time_s[0]; };
  std::vector<EffectCase> cases;
  const double um = units::um;
  cases.push_back(
      {"backlash", "direction: mean", "in yaw: backlash", 0.2 * um, 0.3,
       pattern(kYaw, 0.2 * um, [](const Schedule& s, int i) { return s.direction[static_cast<std::size_t>(i)]; })});
  cases.push_back({"backlash around the turn", "direction: harmonics of the target angle", "order 2", 0.3 * um, 0.3,
                   pattern(kTilt, 0.3 * um, [](const Schedule& s, int i) {
                     return s.direction[static_cast<std::size_t>(i)] * std::cos(2.0 * s.target_rad[i]);
                   })});
  // exp(-0.5) of it is left at the shortest dwell.
  cases.push_back({"settling", "direction: dwell", "in yaw: settling", 0.61 * um, 0.3,
                   pattern(kYaw, 1.0 * um, [](const Schedule& s, int i) {
                     return s.direction[static_cast<std::size_t>(i)] * std::exp(-At(s.dwell_s, i) / 1.0);
                   })});
  cases.push_back({"wander", "time: wander", "3 half waves over the run in tilt", 0.3 * um, 0.3,
                   pattern(kTilt, 0.3 * um, [=](const Schedule& s, int i) {
                     return std::cos(3.0 * units::kPi * (s.time_s[i] - s.time_s[0]) / duration(s));
                   })});
  cases.push_back(
      {"drift", "time: drift", "in lateral: steady drift", 2.0 * um, 0.3,
       pattern(kLateral, 2.0 * um, [=](const Schedule& s, int i) { return s.time_s[i] / duration(s); })});
  cases.push_back({"creep", "time: creep", "in yaw: a mounting that creeps", kNaN, 0.0,
                   pattern(kYaw, 1.0 * um, [](const Schedule& s, int i) {
                     const int start = i - i % 48;  // 12 positions, 4 passes a set-up
                     return std::log10(1.0 + (s.time_s[i] - s.time_s[start]) / 60.0);
                   })});
  cases.push_back({"warm-up", "time: exponential", "since the start of the run", kNaN, 0.0,
                   pattern(kTilt, 2.0 * um, [=](const Schedule& s, int i) {
                     return std::exp(-(s.time_s[i] - s.time_s[0]) / (0.1 * duration(s)));
                   })});
  cases.push_back({"knock", "time: step", "in yaw: a knock", 0.6 * um, 0.3,
                   pattern(kYaw, 0.6 * um, [](const Schedule&, int i) { return i >= 70 ? 1.0 : 0.0; })});
  cases.push_back(
      {"tone", "time: tone", "period 3", 0.3 * um, 0.3, pattern(kAX, 0.3 * um, [](const Schedule& s, int i) {
         return std::sin(kTurn * s.time_s[i] / 31.0);  // s
       })});
  cases.push_back(
      {"target harmonic", "harmonics: target angle", "order 3 of the target angle in yaw", 0.2 * um, 0.3,
       pattern(kYaw, 0.2 * um, [](const Schedule& s, int i) { return std::cos(3.0 * s.target_rad[i]); }), false});
  cases.push_back(
      {"reference harmonic", "harmonics: reference angle", "order 2 of the reference angle in tilt", 0.2 * um, 0.3,
       pattern(kTilt, 0.2 * um, [](const Schedule& s, int i) { return std::sin(2.0 * s.reference_rad[i]); }),
       false});
  cases.push_back(
      {"target lock", "harmonics by set-up", "locked to target", 0.2 * um, 0.3,
       pattern(kYaw, 0.2 * um, [](const Schedule& s, int i) { return std::cos(3.0 * s.target_rad[i]); }), false});
  cases.push_back(
      {"reference lock", "harmonics by set-up", "locked to reference", 0.2 * um, 0.3,
       pattern(kYaw, 0.2 * um, [](const Schedule& s, int i) { return std::cos(3.0 * s.reference_rad[i]); }),
       false});
  const auto in_one_setup = pattern(kYaw, 0.5 * um, [](const Schedule& s, int i) {
    return s.setup[static_cast<std::size_t>(i)] == 1 ? std::cos(3.0 * s.target_rad[i]) : 0.0;
  });
  cases.push_back(
      {"interaction", "harmonics by set-up", "locked to interaction", 0.29 * um, 0.3, in_one_setup, false});
  cases.push_back(
      {"one phase left", "harmonics by set-up", "that so few set-ups cannot tell", kNaN, 0.0, in_one_setup});
  cases.push_back(
      {"temperature", "temperature", "temperature with a lag of 5 min in tilt", kNaN, 0.0, [=](LinearRun& run) {
         const Schedule& s = run.schedule;
         std::vector<double> body = {s.temperature_degC[0]};
         for (int i = 1; i < s.Readings(); ++i) {
           const double part = 1.0 - std::exp(-(s.time_s[i] - s.time_s[i - 1]) / 300.0);
           body.push_back(body.back() + part * (s.temperature_degC[i] - body.back()));
         }
         AddEffect(run, kTilt, [&](int i) { return 10.0 * um * body[static_cast<std::size_t>(i)]; });
       }});
  cases.push_back({"detector cubic", "spot: polynomial", "degree 3 of the spot's own coordinate on psd_a_x", kNaN,
                   0.0, [=](LinearRun& run) {
                     const Eigen::VectorXd u = run.observed;
                     AddEffect(run, kAX, [&](int i) { return 2.0 * um * std::pow(u[4 * i] / (150.0 * um), 3); });
                   }});
  cases.push_back({"fringes", "spot: periodic", "on psd_a_x", 0.25 * um, 0.4, [=](LinearRun& run) {
                     const Eigen::VectorXd u = run.observed;
                     AddEffect(run, kAX,
                               [&](int i) { return 0.25 * um * std::sin(kTurn * u[4 * i] / (40.0 * um)); });
                   }});
  cases.push_back(
      {"ghost", "channel order", "what psd_a_x showed just before psd_a_y", 0.3 * um, 0.4, [=](LinearRun& run) {
         const Eigen::VectorXd u = run.observed;
         AddEffect(run, kAY, [&](int i) { return 0.002 * u[4 * i]; });
       }});
  cases.push_back(
      {"dirt", "spot: map", "residual of psd_a_x depends on where the spot stands", kNaN, 0.0, [=](LinearRun& run) {
         const Eigen::VectorXd u = run.observed;
         AddEffect(run, kAX, [&](int i) {
           const bool there = u[4 * i] > 50.0 * um && u[4 * i + 1] < -50.0 * um;
           return there ? 1.2 * um : 0.0;
         });
       }});
  cases.push_back({"bend", "time: running sum", "the mean of psd_b_y changes near reading 8", kNaN, 0.0,
                   pattern(Vector4d(0, 0, 0, 1), 0.8 * um, [](const Schedule&, int i) {
                     return std::clamp((i - 75) / 15.0, 0.0, 1.0);  // from one level to the other in 15 readings
                   })});
  cases.push_back({"pass offsets", "offsets by pass", "each pass has an offset", 0.5 * um, 0.6,  // 12 passes, drawn
                   [=](LinearRun& run) {
                     std::vector<double> offset;
                     Stream stream(5, "test.pass");
                     for (int k = 0; k < 12; ++k) offset.push_back(0.5 * um * stream.Normal());
                     AddEffect(run, kAX, [&](int i) {
                       return offset[static_cast<std::size_t>(run.schedule.pass[static_cast<std::size_t>(i)])];
                     });
                   }});
  cases.push_back({"shaking body", "channel pattern", "as in tilt", 0.2 * um, 0.4, [=](LinearRun& run) {
                     Stream stream(5, "test.shake");
                     Eigen::VectorXd shake(run.schedule.Readings());
                     for (double& v : shake) v = 0.2 * um * stream.Normal();
                     AddEffect(run, kTilt, [&](int i) { return shake[i]; });
                   }});
  cases.push_back(
      {"correlated noise", "whiteness within a pass", "readings 1 apart", kNaN, 0.0, [=](LinearRun& run) {
         for (int k = 4; k < run.Rows(); ++k) run.residual[k] = 0.4 * run.residual[k - 4] + run.residual[k];
       }});
  cases.push_back({"spike", "outliers", "reading 40 ", 3.0 * um, 0.4,
                   pattern(kAY, 3.0 * um, [](const Schedule&, int i) { return i == 40 ? 1.0 : 0.0; })});
  cases.push_back({"heavy tails", "tails", "Student's t", kNaN, 0.0, [=](LinearRun& run) {
                     Stream stream(5, "test.tails");
                     // Student's t with 3 degrees of freedom is a normal deviate over a root of chi-squared.
                     for (double& r : run.residual) r *= std::sqrt(3.0 / stream.ChiSquared(3.0));
                   }});
  cases.push_back({"noisy channel", "noise of the channels", "psd_b_x", kNaN, 0.0, [=](LinearRun& run) {
                     for (int k = 2; k < run.Rows(); k += 4) run.residual[k] *= 1.4;
                   }});
  cases.push_back({"noisy detector", "noise of the detectors", "psd_b is", kNaN, 0.0, [=](LinearRun& run) {
                     for (int k = 0; k < run.Rows(); ++k) run.residual[k] *= k % 4 >= 2 ? 1.4 : 1.0;
                   }});
  cases.push_back(
      {"speckle", "noise against spot radius", "grows with the distance", kNaN, 0.0, [=](LinearRun& run) {
         for (int i = 0; i < run.schedule.Readings(); ++i) {
           const double radius = run.observed.segment(4 * i, 2).norm() / (150.0 * um);
           run.residual.segment(4 * i, 2) *= 0.3 + 1.2 * radius;
         }
       }});
  cases.push_back({"repeatable interaction", "fit to repeats", "the model lacks something repeatable", 0.3 * um,
                   0.5, [=](LinearRun& run) {
                     Stream stream(5, "test.place");
                     Eigen::MatrixXd place(3, 12);
                     for (double& v : place.reshaped()) v = 0.3 * um * stream.Normal();
                     AddEffect(run, Vector4d::Ones(), [&](int i) {
                       const auto k = static_cast<std::size_t>(i);
                       return place(run.schedule.setup[k], run.schedule.position[k]);
                     });
                   }});
  return cases;
}

class ScreenEffect : public testing::TestWithParam<EffectCase> {};

TEST_P(ScreenEffect, IsSeenByItsOwnTestAtItsOwnSize) {
  const EffectCase& c = GetParam();
  LinearRun run = SyntheticRun({.free_tables = c.free_tables});
  AddNoise(run, 4);
  c.add(run);
  const std::vector<ScreenTest> tests = ScreenAsStated(run, 200, 2);
  const ScreenTest* own = Find(tests, c.test);
  ASSERT_NE(own, nullptr);
  EXPECT_LT(own->p, 0.01);
  EXPECT_NE(own->reading.find(c.says), std::string::npos) << own->reading;
  if (std::isfinite(c.size_m)) {
    EXPECT_NEAR(own->effect_m / c.size_m, 1.0, c.within);
  }
}

std::string NameOf(const testing::TestParamInfo<EffectCase>& of) {
  std::string name = of.param.name;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Cases, ScreenEffect, testing::ValuesIn(Cases()), NameOf);

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
    AddEffect(run, kYaw,
              [&](int i) { return 2.0 * units::um * run.schedule.direction[static_cast<std::size_t>(i)]; });
    const std::vector<ScreenTest> tests = ScreenAsStated(run, 100, seed);
    EXPECT_LT(Find(tests, "direction: mean")->p, 1e-6);
    EXPECT_GT(Find(tests, "direction: dwell")->p, 0.005);  // below in 2.5 % of five runs
  }
}

TEST(Screen, SeesARandomWalkInMeansOverManyReadings) {
  LinearRun run = SyntheticRun({.positions = 48});
  AddNoise(run, 1);
  Stream stream(5, "test.walk");
  Eigen::VectorXd walk(run.schedule.Readings());
  double at = 0.0;
  for (double& v : walk) v = at += 0.1 * units::um * stream.Normal();
  AddEffect(run, kAX, [&](int i) { return walk[i]; });
  const auto tests = ScreenAsStated(run, 200, 1);
  const ScreenTest* allan = Find(tests, "time: Allan deviation");
  ASSERT_NE(allan, nullptr);
  EXPECT_LT(allan->p, 0.01);
  EXPECT_NE(allan->reading.find("means over 8 readings of psd_a_x"), std::string::npos) << allan->reading;
  // A walk of 0.1 um a step has an Allan deviation of 0.1 um sqrt(8 / 3); free tables and passes take some of it.
  EXPECT_GT(allan->effect_m, 0.08 * units::um);
  EXPECT_LT(allan->effect_m, 0.20 * units::um);
}

TEST(Screen, LeavesUnrelatedTestsSilent) {
  const std::map<std::string, std::set<std::string>> related = {
      {"tone", {"time: tone", "whiteness within a pass", "time: Allan deviation"}},
      {"fringes", {"spot: periodic"}},
      {"ghost", {"channel order", "spot: map"}},
      {"spike", {"outliers", "tails"}}};
  constexpr int kSeeds = 10;
  for (const EffectCase& c : Cases()) {
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
