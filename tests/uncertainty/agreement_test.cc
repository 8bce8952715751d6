#include "twin/uncertainty/agreement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/uncertainty/bench_budget.h"
#include "tests/uncertainty/stated.h"

namespace twinbench::uncertainty {
namespace {

using test::Computing, test::FourInputs, test::Input, test::InputKeys;

/// GUM and trials of every quantity.
struct Both {
  std::vector<Budget> budgets;
  MonteCarlo trials;

  const Budget& BudgetOf(const std::string& name) const {
    return *std::ranges::find(budgets, name, [](const Budget& b) -> const auto& { return b.quantity.name; });
  }
  const Spread& SpreadOf(const std::string& name) const {
    return *std::ranges::find(trials.spreads, name, [](const Spread& s) -> const auto& { return s.quantity.name; });
  }
  Agreement Of(const std::string& name) const { return Compare(BudgetOf(name), SpreadOf(name), trials.trials); }
};

Both BothOf(const Scenario& scenario, const Evaluate& evaluate, int trials) {
  return {Budgets(scenario, evaluate), Propagate(scenario, evaluate, test::Trials(trials))};
}

TEST(Agreement, HasTheToleranceOfTheSupplement) {
  EXPECT_DOUBLE_EQ(NumericalTolerance(0.25, 1), 0.05);   // JCGM 101, 7.9.2: 2 x 10^-1
  EXPECT_DOUBLE_EQ(NumericalTolerance(0.25, 2), 0.005);  // 25 x 10^-2
  EXPECT_DOUBLE_EQ(NumericalTolerance(37.0, 1), 5.0);
}

/// A sum of normal inputs, and one that repeats to few degrees of freedom.
TEST(Agreement, IsThereForWhatIsLinear) {
  const Scenario scenario = FourInputs({{InputKeys()[0], 1e-3}, {InputKeys()[1], 2e-3}});
  const auto sum = Computing("y", [](const Scenario& s) { return 1e3 * (Input(s, 0) + Input(s, 1)); }, 2.0);
  const Agreement agreement = BothOf(scenario, sum, 4000).Of("y");
  EXPECT_EQ(agreement.verdict, Verdict::kAgree) << agreement.d_low << " " << agreement.d_high;
}

/// y = x^2 about 0 has no first order at all: u is right by the second, the interval is not. With x standard normal y is chi-squared of one
/// degree of freedom: all of it lies above zero, and the shortest 95 % interval is not the symmetric one.
TEST(Agreement, IsNotThereForASquare) {
  const Scenario scenario = FourInputs({{InputKeys()[0], 1e-3}});
  const Both both = BothOf(scenario, Computing("y", test::SquareOfFirst), 8000);
  EXPECT_NEAR(both.BudgetOf("y").u, std::sqrt(2.0), 1e-9);
  const Spread& spread = both.SpreadOf("y");
  EXPECT_NEAR(spread.sd, std::sqrt(2.0), 0.15);
  EXPECT_NEAR(spread.shortest[0], 0.0, 0.01);
  EXPECT_NEAR(spread.shortest[1], 3.84, 0.15);
  EXPECT_NEAR(spread.symmetric[1], 5.02, 0.25);
  EXPECT_EQ(both.Of("y").verdict, Verdict::kDiffer);
  EXPECT_NEAR(both.Of("y").d_low, 1.96 * std::sqrt(2.0), 0.01) << "no trial lies below zero";
}

TEST(Agreement, SaysWhenTrialsAreTooFew) {
  const Budget budget{{"y", 0.0, 9.0}, {}, 9.0};
  const Spread spread{{"y", 0.0, 9.0}, 0.0, 9.0, {-17.0, 17.3}, {}};
  EXPECT_EQ(Compare(budget, spread, 200).verdict, Verdict::kTooFewTrials);
}

/// scenarios/circular_encoder_tilt.toml: a lean t of the encoder's axis is an error of t^2 / 4 twice a turn. Both leans of
/// 5 mrad: 1.289 arcsec times chi-squared of two degrees of freedom, whose 97.5 % quantile is 7.38.
TEST(Agreement, IsNotThereForTheTiltOfAnEncoder) {
  const Scenario scenario = test::Small({"circular_encoder_tilt.toml", {}});
  const std::vector<Reading> readings = test::ReadingsOf(scenario);
  const Both both = BothOf(scenario, [&](const Scenario& s) { return test::QuantitiesFrom(s, readings); }, 250);
  const std::string tilted = "errors.encoder.ellipticity_arcsec", straight = "errors.machine.squareness_arcsec";
  const double unit_arcsec = 0.25 * 25e-6 / units::arcsec;
  EXPECT_NEAR(both.BudgetOf(tilted).u, 2.0 * unit_arcsec, 0.4 * unit_arcsec) << "in second order alone, and noise";
  // Of 250 trials the quantile is known to 0.8 of the unit.
  EXPECT_NEAR(both.SpreadOf(tilted).symmetric[1], 7.38 * unit_arcsec, 2.4 * unit_arcsec);
  EXPECT_GT(both.SpreadOf(tilted).shortest[0], -0.5) << "an amplitude is not below zero";
  EXPECT_EQ(both.Of(tilted).verdict, Verdict::kDiffer);
  EXPECT_NE(both.Of(straight).verdict, Verdict::kDiffer);
}

}  // namespace
}  // namespace twinbench::uncertainty
