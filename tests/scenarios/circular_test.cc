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
  const auto against = separate::circular::CompareWithGrid(Circles("circular_machining_centre.toml").rigorous.paths);
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

}  // namespace
}  // namespace twinbench
