#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/angle_benches.h"
#include "twin/benches/circular_motion/analysis.h"

// The answers that the scenarios of the circles promise.
namespace twinbench {
namespace {

using namespace benches::circular;
using units::um;

struct Evaluated {
  test::BenchRun run;
  CircleAnalysis rigorous, published;
};

const Evaluated& Circles(const std::string& file) {
  static std::map<std::string, Evaluated> evaluated;
  const auto found = evaluated.find(file);
  if (found != evaluated.end()) return found->second;
  const test::BenchRun run = test::RunCircles(LoadScenario(test::ScenarioPath(file)));
  return evaluated[file] = {run, Analyse(run.scenario, run.readings, Estimator::kRigorous),
                            Analyse(run.scenario, run.readings, Estimator::kPublished)};
}

/// Largest error of the paths of one set-up, radial and tangential.
Eigen::Vector2d WorstAgainstTruth_m(const Evaluated& e, const CircleAnalysis& a) {
  Eigen::Vector2d worst_m(0.0, 0.0);
  for (const auto& path : a.paths) {
    const auto& truth = *std::ranges::find_if(e.run.truth["path"], [&](const nlohmann::json& t) {
      return t["setup"] == path.setup && t["pass"] == path.pass;
    });
    for (std::size_t i = 0; i < path.points.size(); ++i) {
      auto error = path.points[i];
      error.d_m -= um * Eigen::Vector2d(truth["dx_um"][i].get<double>(), truth["dy_um"][i].get<double>());
      worst_m = worst_m.cwiseMax(Eigen::Vector2d(std::abs(error.Radial_m()), std::abs(error.Tangential_m())));
    }
  }
  return worst_m;
}

TEST(CircularMotion, BarAndGridAgreeWithinTwoMicrometres) {
  const auto against =
      separate::circular::CompareWithGrid(Circles("circular_machining_centre.toml").rigorous.paths);
  EXPECT_EQ(against.pairs, 4 * 240 + 2 * 36);
  EXPECT_LT(against.radial_max_m, 2.0 * um);
  EXPECT_LT(against.tangential_max_m, 2.0 * um);
}

TEST(CircularMotion, FindsTheMachinesErrorsWithinTheirUncertainties) {
  const Evaluated& e = Circles("circular_machining_centre.toml");
  int compared = 0;
  double sum = 0.0;
  for (const ErrorValue& found : ErrorsOf(e.rigorous.fit)) {
    // An amplitude that is not there is found as large as its noise; its mean is not zero.
    const double truth =
        e.run.truth["errors"].contains(found.key) ? e.run.truth["errors"][found.key].get<double>() : 0;
    if (!std::isfinite(found.u) || found.unit == "deg" || truth == 0.0) continue;
    EXPECT_NEAR(found.value, truth, 4.0 * found.u) << found.key;
    sum += std::pow((found.value - truth) / found.u, 2);
    ++compared;
  }
  EXPECT_GE(compared, 14);
  EXPECT_LT(sum / compared, 2.5) << "chi-squared of 14 or more: above that once in a thousand";
}

TEST(CircularMotion, ThePublishedTangentIsWrongAndItsRadiusIsNot) {
  const Evaluated& e = Circles("circular_machining_centre.toml");
  const Eigen::Vector2d published_m = WorstAgainstTruth_m(e, e.published);
  const Eigen::Vector2d rigorous_m = WorstAgainstTruth_m(e, e.rigorous);
  EXPECT_GT(published_m.y(), 20.0 * um) << "zero of the encoder and centre";
  EXPECT_LT(published_m.x(), 15.0 * um) << "length of the bar, up to 10 um, stays in it";
  EXPECT_LT(rigorous_m.maxCoeff(), 2.0 * um) << "six standard deviations of a reading";
}

TEST(CircularBarOnly, SaysWhatItCannotTellApart) {
  const CircleAnalysis& a = Circles("circular_bar_only.toml").rigorous;
  bool found_backlash = false;
  for (const ErrorValue& e : ErrorsOf(a.fit)) {
    if (e.key == "encoder.latency_s") {
      EXPECT_TRUE(std::isnan(e.u));
    }
    if (e.key != "machine.backlash_x_um") continue;
    found_backlash = true;
    EXPECT_NEAR(e.value, 2.4, 4.0 * e.u);
  }
  EXPECT_TRUE(found_backlash);
  EXPECT_FALSE(a.fit.not_separable.empty());
}

/// The same machine in closed form: lags, and lost motion as backlash.
Scenario InClosedForm(Scenario scenario, const nlohmann::json& truth) {
  CircularSettings& s = CircularOf(scenario);
  s.mechanics.fidelity = "kinematic";
  for (std::size_t k = 0; k < 2; ++k) {
    const std::string axis = k == 0 ? "x" : "y";
    s.machine.lag_s[k] = truth["errors"]["machine.lag_" + axis + "_s"];
    s.machine.backlash_m[k] = um * truth["errors"]["machine.backlash_" + axis + "_um"].get<double>();
  }
  return scenario;
}

/// Largest radial and tangential difference of two runs, of one set-up at one feed.
Eigen::Vector2d Apart_m(const std::vector<Reading>& a, const std::vector<Reading>& b, int setup,
                        double feed_mm_min) {
  Eigen::Vector2d apart_m(0.0, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].setup != setup || std::abs(kFeed_m_s(a[i]) - feed_mm_min * units::mm / 60.0) > 1e-9) continue;
    const Deviation of_a = DeviationOf(a[i]), of_b = DeviationOf(b[i]);
    apart_m = apart_m.cwiseMax(
        Eigen::Vector2d(std::abs(of_a.radial_m - of_b.radial_m), std::abs(of_a.tangential_m - of_b.tangential_m)));
  }
  return apart_m;
}

TEST(CircularBodies, DifferFromTheClosedFormAsTheScenarioSays) {
  Scenario scenario = LoadScenario(test::ScenarioPath("circular_bodies.toml"));
  scenario.noise_free = true;
  const test::BenchRun bodies = test::RunCircles(scenario);
  const std::vector<Reading> closed = test::CircleReadings(InClosedForm(scenario, bodies.truth));
  const auto apart_um = [&](int setup, double feed_mm_min) -> Eigen::Vector2d {
    return Apart_m(bodies.readings, closed, setup, feed_mm_min) / um;
  };
  // A screw of 143 N/um, held by 30 % more than the Coulomb force: 0.42 um on either side of x.
  constexpr double kDigits_um = 0.02;
  for (const int setup : {0, 1, 2}) EXPECT_NEAR(apart_um(setup, 40.0).x(), 0.42, kDigits_um) << setup;
  EXPECT_NEAR(apart_um(0, 40.0).y(), 0.47, kDigits_um);
  EXPECT_NEAR(apart_um(0, 1000.0).x(), 1.97, 0.05) << "and stick at their reversals";
  EXPECT_NEAR(apart_um(1, 1000.0).x(), 0.71, 0.05) << "which readings of a larger circle meet elsewhere";
}

/// Of the fit of the closed form.
double Fitted(const Evaluated& e, const std::string& key) {
  for (const ErrorValue& error : ErrorsOf(e.rigorous.fit)) {
    if (error.key == key) return error.value;
  }
  return std::nan("");
}

TEST(CircularBodies, AreFittedByTheClosedFormAsTheScenarioSays) {
  const Evaluated& e = Circles("circular_bodies.toml");
  EXPECT_NEAR(Fitted(e, "machine.backlash_x_um"), 4.55, 0.05);  // u = 0.012
  EXPECT_NEAR(Fitted(e, "machine.backlash_y_um"), 2.12, 0.05);
  EXPECT_NEAR(Fitted(e, "machine.lag_x_s"), 0.986e-3, 4e-6);  // u = 0.86e-6
  EXPECT_NEAR(Fitted(e, "machine.lag_y_s"), 1.039e-3, 4e-6);
  EXPECT_LT(WorstAgainstTruth_m(e, e.rigorous).maxCoeff(), 2.0 * um) << "the path itself is measured";
}

}  // namespace
}  // namespace twinbench
