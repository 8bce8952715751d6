#include "twin/core/distributions.h"

#include <gtest/gtest.h>

#include <cmath>

namespace twinbench {
namespace {

TEST(ChiSquaredExceedance, AgreesWithTables) {
  // Upper 0.001 points of printed tables: half a unit of their last digit is 3e-7 of probability, or less.
  EXPECT_NEAR(ChiSquaredExceedance(10.828, 1.0), 0.001, 3e-7);
  EXPECT_NEAR(ChiSquaredExceedance(16.266, 3.0), 0.001, 3e-7);
  EXPECT_NEAR(ChiSquaredExceedance(29.588, 10.0), 0.001, 3e-7);
  EXPECT_NEAR(ChiSquaredExceedance(149.449, 100.0), 0.001, 3e-7);
}

TEST(ChiSquaredExceedance, IsAnExponentialForTwoDegreesOfFreedomAndRightBetweenWholeOnes) {
  EXPECT_DOUBLE_EQ(ChiSquaredExceedance(5.0, 2.0), std::exp(-2.5));
  EXPECT_GT(ChiSquaredExceedance(5.0, 2.5), ChiSquaredExceedance(5.0, 2.0));
  EXPECT_LT(ChiSquaredExceedance(5.0, 2.5), ChiSquaredExceedance(5.0, 3.0));
}

TEST(ChiSquaredExceedance, KnowsNothingWithoutDegreesOfFreedom) {
  EXPECT_TRUE(std::isnan(ChiSquaredExceedance(5.0, 0.0)));
}

TEST(NormalExceededWith, IsTheInverseOfTheTail) {
  for (const double p : {0.4, 0.025, 1e-9})
    EXPECT_NEAR(0.5 * std::erfc(NormalExceededWith(p) / std::sqrt(2.0)) / p, 1.0, 1e-12);
}

}  // namespace
}  // namespace twinbench
