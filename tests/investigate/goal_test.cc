#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/core/input_error.h"
#include "tests/investigate/hidden_investigation.h"
#include "twin/investigate/goal.h"

namespace twinbench::investigate {
namespace {

nlohmann::json Results(double u) {
  return {{"separation",
           {{"target",
             {{"ez_arcsec", {1.0, 2.0}}, {"u_ez_arcsec", {u, u}}, {"dx_um", {0.1, 0.2}}, {"u_dx_um", {9.0, 9.0}}}},
            {"reference", {{"ez_arcsec", {3.0, 4.0}}, {"u_ez_arcsec", {7.0, 7.0}}}}}}};
}

TEST(Goal, IsReadWithItsUnit) {
  const Goal goal = ParseGoal("target.ez 0.1arcsec");
  EXPECT_EQ(goal.quantity, "target.ez");
  EXPECT_EQ(goal.unit, "arcsec");
  EXPECT_EQ(goal.u, 0.1);
  EXPECT_EQ(ParseGoal("ratio 2e-3").u, 2e-3);
  for (const char* bad : {"", "target.ez", "0.1arcsec", "target.ez 0arcsec", "target.ez -1arcsec"})
    EXPECT_THROW(ParseGoal(bad), InputError) << bad;
}

TEST(Goal, NamesWhatCanBeAskedFor) {
  nlohmann::json results = Results(0.3);
  results["terms"] = {{{"amplitude_arcsec", 1.0}, {"u_amplitude_arcsec", 0.1}}};
  EXPECT_EQ(GoalNames(results),
            (std::vector<std::string>{"separation.reference.ez_arcsec", "separation.target.dx_um",
                                      "separation.target.ez_arcsec"}));
}

TEST(Goal, CountsOnlyTheQuantityThatWasAskedFor) {
  Certainty certainty(ParseGoal("target.ez 0.1arcsec"));
  EXPECT_TRUE(std::isinf(certainty.u()));
  EXPECT_TRUE(certainty.Add(Results(0.3)));
  EXPECT_NEAR(certainty.u(), 0.3, 1e-12);
  Certainty other(ParseGoal("target.ey 0.1arcsec"));
  EXPECT_FALSE(other.Add(Results(0.3)));
}

TEST(Goal, RunsAddUpByTheirInverseVariances) {
  Certainty certainty(ParseGoal("target.ez 0.2arcsec"));
  certainty.Add(Results(0.3));
  EXPECT_FALSE(certainty.IsMet());
  EXPECT_NEAR(certainty.With(Results(0.3)), 0.3 / std::sqrt(2.0), 1e-12);
  certainty.Add(Results(0.15));
  EXPECT_NEAR(certainty.u(), 1.0 / std::sqrt(1.0 / 0.09 + 1.0 / 0.0225), 1e-12);
  EXPECT_TRUE(certainty.IsMet());
}

uncertainty::Budget Budget(int place, double standard, double rounding) {
  uncertainty::Budget budget;
  budget.quantity.name = "separation.target.ez_arcsec[" + std::to_string(place) + "]";
  for (const auto& [name, u] : {std::pair{"noise", 0.5}, {"autocollimator.gain_error", standard}, {"quantisation", rounding}}) {
    budget.sources.emplace_back().name = name;
    budget.sources.back().u = u;
  }
  budget.sources.front().type = 'A';
  return budget;
}

TEST(Goal, WhatAllRunsShareIsAddedAndNeverGrowsLess) {
  Certainty certainty(ParseGoal("target.ez 0.2arcsec"));
  certainty.Share({Budget(0, -0.3, 0.1), Budget(1, 0.4, 0.1)});
  EXPECT_NEAR(certainty.SharedU(), std::sqrt((0.09 + 0.16) / 2.0), 1e-12);
  EXPECT_EQ(certainty.LargestShared(), "autocollimator.gain_error");
  for (int run = 1; run <= 4; ++run) {
    certainty.Add(Results(0.6));
    EXPECT_NEAR(certainty.u(), std::sqrt(0.36 / run + 0.125), 1e-12);
  }
}

TEST(Goal, OfWhatARunStatesTheStandardsPartIsNotCountedAgain) {
  nlohmann::json results = Results(0.5);
  results["separation"]["u_parts"] = {{"noise", 0.36}, {"standard", 0.64}};
  Certainty certainty(ParseGoal("target.ez 0.2arcsec"));
  certainty.Add(results);
  EXPECT_NEAR(certainty.u(), 0.3, 1e-12);
}

// Five of the score's seeds in a row: a scale, an ellipticity, a slip, a drift, an order of a half. More of them by
// tools/scores --set investigate.
TEST(InvestigateAProgram, TellsWhatABenchHidesThatSharesNothingWithTheTwin) {
  const TemporaryFolder folder;
  constexpr std::uint64_t kFirst = 5, kLast = 9;
  int right = 0;
  for (std::uint64_t seed = kFirst; seed <= kLast; ++seed) {
    const Judged judged = InvestigateProgram(TWINBENCH_TEST_DATA "/program/acquire_hidden.py", seed,
                                             folder.File(std::to_string(seed)));
    right += judged.IsRight() ? 1 : 0;
    EXPECT_FALSE(judged.result == Result::kWrong && judged.probability > 0.95)
        << judged.truth << ": " << judged.answer;
  }
  EXPECT_GE(right, 4);
}

}  // namespace
}  // namespace twinbench::investigate
