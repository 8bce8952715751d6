#include "twin/core/distributions.h"

#include <gtest/gtest.h>

#include <cmath>

namespace twinbench {
namespace {

TEST(ChiSquaredExceedance, AgreesWithTablesAndIsAnExponentialForTwoDegreesOfFreedomAndRightBetweenWholeOnes) {
  // Upper 0.001 points of printed tables: half a unit of their last digit is 3e-7 of probability, or less.
  EXPECT_NEAR(ChiSquaredExceedance(10.828, 1.0), 0.001, 3e-7);
  EXPECT_NEAR(ChiSquaredExceedance(16.266, 3.0), 0.001, 3e-7);
  EXPECT_NEAR(ChiSquaredExceedance(29.588, 10.0), 0.001, 3e-7);
  EXPECT_NEAR(ChiSquaredExceedance(149.449, 100.0), 0.001, 3e-7);
  EXPECT_DOUBLE_EQ(ChiSquaredExceedance(5.0, 2.0), std::exp(-2.5));
  EXPECT_GT(ChiSquaredExceedance(5.0, 2.5), ChiSquaredExceedance(5.0, 2.0));
  EXPECT_LT(ChiSquaredExceedance(5.0, 2.5), ChiSquaredExceedance(5.0, 3.0));
}

TEST(ChiSquaredExceedance, IsCertainForNothingInThousandsOfDegreesOfFreedomAndKnowsNothingWithoutAny) {
  EXPECT_TRUE(std::isnan(ChiSquaredExceedance(5.0, 0.0)));
  for (const double chi2 : {0.0, 1e-20, 1.0}) EXPECT_EQ(ChiSquaredExceedance(chi2, 10000.0), 1.0) << chi2;
  EXPECT_NEAR(ChiSquaredExceedance(10000.0, 10000.0), 0.5, 0.003);  // skewed by 2 / (3 sqrt(2 pi dof))
}

TEST(NormalExceededWith, IsTheInverseOfTheTail) {
  for (const double p : {0.4, 0.025, 1e-9})
    EXPECT_NEAR(0.5 * std::erfc(NormalExceededWith(p) / std::sqrt(2.0)) / p, 1.0, 1e-12);
}

TEST(LogDensities, AreThoseOfCauchyForOneDegreeOfFreedomAndOfANormalForVeryMany) {
  EXPECT_NEAR(StudentLogDensity(1.5, 1.0, 0.5), -std::log(M_PI * 0.5 * (1.0 + 9.0)), 1e-14);
  EXPECT_NEAR(NormalLogDensity(0.6, 0.5), std::log(std::exp(-0.72) / (0.5 * std::sqrt(2.0 * M_PI))), 1e-14);
  // The next term of the series is of the order of 1 / dof.
  EXPECT_NEAR(StudentLogDensity(0.6, 1e6, 0.5), NormalLogDensity(0.6, 0.5), 1e-6);
}

TEST(Median, IsOneOfTheValues) {
  EXPECT_EQ(Median({5.0, 1.0, 3.0}), 3.0);
  EXPECT_EQ(Median({5.0, 1.0, 3.0, 2.0}), 3.0);  // the upper one
}

}  // namespace
}  // namespace twinbench
