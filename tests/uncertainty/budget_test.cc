#include "twin/uncertainty/budget.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tests/uncertainty/stated.h"

namespace twinbench::uncertainty {
namespace {

using test::Computing, test::FourInputs, test::Input, test::InputKeys;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

void ExpectAddsUp(const Budget& budget) {
  double sum2 = 0.0;
  for (const Source& source : budget.sources) sum2 += source.u * source.u;
  EXPECT_NEAR(sum2, budget.u * budget.u, 1e-9 * sum2);
}

/// The end gauge of GUM, H.1, with its four largest contributions [nm] and their degrees of freedom.
TEST(Budget, OfTheEndGaugeIsThatOfTheGuide) {
  const Scenario scenario = FourInputs({{InputKeys()[0], 9.7e-9, Distribution::kNormal, 25.6},
                                        {InputKeys()[1], 2.9e-9, Distribution::kNormal, 50.0},
                                        {InputKeys()[2], 16.6e-9, Distribution::kNormal, 2.0}});
  const auto length_nm = [](const Scenario& s) { return 1e9 * (Input(s, 0) + Input(s, 1) - Input(s, 2)); };
  const Budget budget = Budgets(scenario, Computing("length_nm", length_nm, 25.0, 18.0)).at(0);
  ExpectAddsUp(budget);
  EXPECT_NEAR(budget.u, 31.67, 0.01);
  EXPECT_NEAR(budget.dof, 16.76, 0.01);
  EXPECT_NEAR(budget.k, 2.112, 0.002) << "Student's t at 16.76 degrees of freedom";
  ASSERT_EQ(budget.sources.size(), 4U) << "a straight line has no second order";
  EXPECT_EQ(budget.sources[0].type, 'A');
  EXPECT_NEAR(budget.sources[3].u, -16.6, 1e-6) << "with the sign of the sensitivity";
}

TEST(Budget, TakesEveryNumberOfAList) {
  const Scenario scenario = FourInputs({{"grating.point_mm", 1e-3}});
  const auto sum = [](Scenario s) {
    const auto numbers = NumbersAt(s, "grating.point_mm");
    return std::accumulate(numbers.begin(), numbers.end(), 0.0);
  };
  const Budget budget = Budgets(scenario, Computing("sum", sum)).at(0);
  EXPECT_NEAR(budget.u, std::sqrt(3.0) * 1e-3, 1e-12);
  EXPECT_EQ(budget.sources[2].name, "grating.point_mm[1]");
}

TEST(Budgets, NameWhatNoResultIsComputedWith) {
  const Scenario scenario = FourInputs({{"grating.point_mm", 1e-3}, {"laser.wavelength_nm", 1e-11}});
  const auto first = [](const Scenario& s) {
    Scenario copy = s;
    return std::vector<Quantity>{{"first", NumbersAt(copy, "grating.point_mm")[0], 0.1},
                                 {"wave", 2.0 * NumbersAt(copy, "laser.wavelength_nm")[0], 0.1}};
  };
  EXPECT_EQ(SourcesOfNothing(Budgets(scenario, first)),
            (std::vector<std::string>{"grating.point_mm[1]", "grating.point_mm[2]"}));
}

/// 0.3 arcsec per um of a distance that is known to 2 um.
TEST(Budget, StatesSensitivitiesInTheUnitOfTheKey) {
  const Scenario scenario = FourInputs({{InputKeys()[0], 2e-6}});
  const auto line = Computing("ez_arcsec", [](const Scenario& s) { return -0.3e6 * Input(s, 0); }, 0.1);
  const Source source = Budgets(scenario, line).at(0).sources.at(1);
  EXPECT_NEAR(source.u_input, 2e-3, 1e-12) << "mm, as distance_mm";
  EXPECT_EQ(source.input_unit, "mm");
  EXPECT_NEAR(source.sensitivity, -300.0, 1e-6) << "arcsec per mm";
  EXPECT_NEAR(source.u, source.sensitivity * source.u_input, 1e-12);
}

/// What an estimator tells apart stands line by line, but its degrees of freedom are those of one estimate.
TEST(Budget, HasThePartsOfTheReadings) {
  const Scenario scenario = FourInputs({{InputKeys()[0], 1e-3, Distribution::kNormal, 5.0}});
  const auto evaluate = [](const Scenario& s) {
    const double x = 1e3 * Input(s, 0);
    return std::vector<Quantity>{
        {"y", x + x * x, 2.0, 10.0, {{"noise", 0.5}, {"quantisation", 0.25}, {"second order", 0.25}}}};
  };
  const Budget budget = Budgets(scenario, evaluate).at(0);
  ASSERT_EQ(budget.sources.size(), 4U) << "both second orders in one line";
  EXPECT_EQ(budget.sources[0].type, 'A');
  EXPECT_EQ(budget.sources[1].type, 'B');
  EXPECT_NEAR(budget.sources[0].u, std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(budget.sources[2].u, std::sqrt(1.0 + 2.0), 1e-9) << "0.25 of 4, and 2 x 1^2 of the key";
  EXPECT_NEAR(budget.u * budget.u, 4.0 + 1.0 + 2.0, 1e-9);
  ExpectAddsUp(budget);
  EXPECT_NEAR(budget.dof, 49.0 / (16.0 / 10.0 + 1.0 / 5.0), 1e-6);
}

TEST(CoverageFactor, IsThatOfTheTables) {
  EXPECT_NEAR(CoverageFactor(kInfinite), 1.960, 0.001);
  EXPECT_NEAR(CoverageFactor(10.0), 2.228, 0.001);
  EXPECT_NEAR(CoverageFactor(2.0), 4.303, 0.001);
}

}  // namespace
}  // namespace twinbench::uncertainty
