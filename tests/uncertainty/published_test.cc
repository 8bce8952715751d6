#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "tests/uncertainty/bench_budget.h"

// The published estimators of the other benches: an uncertainty that holds, or none (rotary_4dof:
// tests/scenarios/published_test.cc).
namespace twinbench::uncertainty {
namespace {

using test::Small, test::SmallBenches;

/// (error / u)^2 of each list of the score, mean over its values and the seeds. What is invalid is not scored.
std::map<std::string, double> MeanSquares(std::size_t bench, int seeds) {
  std::map<std::string, std::pair<double, int>> sums;
  for (int seed = 1; seed <= seeds; ++seed) {
    const Scenario scenario = Small(SmallBenches()[bench], {"seed=" + std::to_string(seed)});
    const auto twin = BenchOf(scenario).make_twin(scenario);
    const auto record = RunRecord::CreateInMemory({"", "twin", scenario.seed, "", scenario.bench});
    twin->CarryOut(*record, [](const procedure::Progress&) {});
    const auto score = BenchOf(scenario).score(scenario, record->Readings(), twin->Truth(), Estimator::kPublished);
    for (const report::ScoredValue& v : score.values) {
      EXPECT_GT(v.u, 0.0) << v.name;
      auto& [sum, count] = sums[KindOf(v.name)];
      sum += std::pow((v.value - v.truth) / v.u, 2);
      ++count;
    }
  }
  std::map<std::string, double> means;
  for (const auto& [kind, sum] : sums) means[kind] = sum.first / sum.second;
  return means;
}

void ExpectHonest(std::size_t bench, int seeds, const std::vector<std::string>& kinds) {
  const std::map<std::string, double> means = MeanSquares(bench, seeds);
  for (const std::string& kind : kinds) {
    ASSERT_TRUE(means.contains(kind)) << kind;
    testing::Test::RecordProperty(kind, std::to_string(means.at(kind)));
    EXPECT_LT(means.at(kind), 2.0) << kind;
    EXPECT_GT(means.at(kind), 0.1) << kind;
  }
}

TEST(PublishedOfOtherBenches, HoldsForEquation5) {
  ExpectHonest(1, 12, {"equation 5.ez_arcsec"});
}

TEST(PublishedOfOtherBenches, HoldsForTwoHeadPositions) {
  ExpectHonest(2, 8, {"two positions.amplitude_arcsec"});
}

TEST(PublishedOfOtherBenches, HoldsForThePathOfTheBar) {
  ExpectHonest(3, 2, {"path[].dx_um", "path[].dy_um"});
}

TEST(PublishedOfOtherBenches, HoldsForTheMapOfTheTip) {
  ExpectHonest(4, 2, {"error_map.dx_um", "error_map.dy_um", "error_map.dz_um"});
}

/// Both tilts alike at a position: the equation divides by nearly nothing. The number stays, its u does not.
TEST(PublishedOfOtherBenches, HasNoUncertaintyNearAPole) {
  const Scenario scenario = Small(SmallBenches()[1]);
  const std::vector<Reading> readings = test::ReadingsOf(scenario);
  const nlohmann::json results = BenchOf(scenario).evaluate(scenario, readings, Estimator::kPublished).results;
  const nlohmann::json& points = results.at("equation_5");
  int near = 0;
  for (std::size_t i = 0; i < points.at("status").size(); ++i) {
    if (points.at("status")[i] != "near_pole" || points.at("u_ez_arcsec")[i] == 0.0) continue;
    EXPECT_TRUE(points.at("u_ez_arcsec")[i].is_null()) << i;
    ++near;
  }
  EXPECT_GT(near, 0);
  EXPECT_NE(results.at("notes").dump().find("INVALID"), std::string::npos);
}

/// The patent's equations know no pivot: they are named, and coefficients of theirs are no results.
TEST(PublishedOfOtherBenches, NamesWhatTheEquationsOfThePatentMiss) {
  const Scenario scenario = Small(SmallBenches()[4]);
  const std::vector<Reading> readings = test::ReadingsOf(scenario);
  const report::Evaluation published = BenchOf(scenario).evaluate(scenario, readings, Estimator::kPublished);
  EXPECT_EQ(published.results.at("method_bias").at("dx_um").at("status"), "biased");
  EXPECT_FALSE(published.results.contains("squareness"));
  EXPECT_NE(published.summary.find("BIASED"), std::string::npos);
  EXPECT_NE(published.summary.find("INVALID"), std::string::npos);
}

}  // namespace
}  // namespace twinbench::uncertainty
