#include <gtest/gtest.h>

#include <map>

#include "tests/support/angle_benches.h"
#include "twin/benches/registry.h"
#include "twin/report/evaluation.h"

// The answers that the scenarios of the freeform artefact promise.
namespace twinbench {
namespace {

struct EvaluatedFreeform {
  nlohmann::json results, separation, score;
};

const EvaluatedFreeform& Freeform(const std::string& file) {
  static std::map<std::string, EvaluatedFreeform> evaluated;
  const auto found = evaluated.find(file);
  if (found != evaluated.end()) return found->second;
  const Scenario scenario = LoadScenario(test::ScenarioPath(file));
  const Bench& bench = BenchOf(scenario);
  const nlohmann::json truth = bench.make_twin(scenario)->Truth();
  const std::vector<Reading> readings = test::ReadingsOf(scenario);
  const report::Evaluation e = bench.evaluate(scenario, readings, Estimator::kRigorous);
  return evaluated[file] = {e.results, e.separation,
                            bench.score(scenario, readings, truth, Estimator::kRigorous).json};
}

double OfScore(const EvaluatedFreeform& e, const char* key) {
  return e.score.at("volumetric_um").at(key).get<double>();
}

TEST(FreeformFiveAxis, NamesThe37DirectionsThatAreNotInTheReadings) {
  const EvaluatedFreeform& e = Freeform("freeform_five_axis.toml");
  EXPECT_EQ(e.separation.at("rank"), 114);
  EXPECT_EQ(e.separation.at("unknowns"), 151);
  EXPECT_EQ(e.separation.at("not_separable").size(), 37u);
}

TEST(FreeformFiveAxis, PredictsTheTipWhereTheProbeHasNotBeen) {
  const EvaluatedFreeform& e = Freeform("freeform_five_axis.toml");
  EXPECT_GT(OfScore(e, "machine_rms"), 3.0);
  EXPECT_LT(OfScore(e, "left_rms"), OfScore(e, "machine_rms") / 8.0);
  // 77 combinations that count: an rms of theirs is what their uncertainty says within 30 %.
  EXPECT_NEAR(OfScore(e, "left_rms") / OfScore(e, "u_rms"), 1.0, 0.3);
  EXPECT_NEAR(e.results.at("volumetric_um").at("machine_rms").get<double>(), OfScore(e, "machine_rms"), 0.5);
}

TEST(FreeformFiveAxis, MapsItsVolumeBeforeAndAfterCompensation) {
  const nlohmann::json grids = Freeform("freeform_five_axis.toml").score.at("volumetric_grid_um");
  ASSERT_EQ(grids.size(), 4u);
  EXPECT_EQ(grids[0].at("a_deg"), 0.0);
  EXPECT_EQ(grids[0].at("b_deg"), 0.0);
  EXPECT_NEAR(grids[3].at("b_deg").get<double>(), 5.0, 0.2);  // half-way to 10 deg
  for (const nlohmann::json& grid : grids)
    EXPECT_LT(grid.at("left_rms").get<double>(), grid.at("machine_rms").get<double>() / 5.0) << grid.dump();
}

TEST(FreeformOneRadius, LeavesMoreThanTwoCurvatures) {
  const EvaluatedFreeform &one = Freeform("freeform_one_radius.toml"), &two = Freeform("freeform_five_axis.toml");
  EXPECT_GT(one.separation.at("rank").get<int>(), 100);
  EXPECT_GT(OfScore(one, "left_rms"), 1.3 * OfScore(two, "left_rms"));
}

}  // namespace
}  // namespace twinbench
