#include "twin/investigate/expected_information.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace twinbench::investigate {
namespace {

Expectation At(double probability, double mean, double spread = 0.0) {
  return {probability, Eigen::VectorXd::Constant(1, mean), Eigen::MatrixXd::Constant(1, 1, spread)};
}

double Normal(double x, double mean, double sd) {
  const double z = (x - mean) / sd;
  return std::exp(-0.5 * z * z) / (sd * std::sqrt(2.0 * std::numbers::pi));
}

/// Mutual information of two normal distributions in one dimension, by the trapezoidal rule.
double ByIntegral(double p, double mean_a, double sd_a, double mean_b, double sd_b) {
  double bits = 0.0;
  constexpr double kStep = 0.001, kNone = 1e-200;
  for (double x = -40.0; x < 40.0; x += kStep) {
    const double a = p * Normal(x, mean_a, sd_a), b = (1.0 - p) * Normal(x, mean_b, sd_b);
    if (a > kNone) bits += kStep * a * std::log2(a / (p * (a + b)));
    if (b > kNone) bits += kStep * b * std::log2(b / ((1.0 - p) * (a + b)));
  }
  return bits;
}

TEST(ExpectedInformation, IsNothingWhereAllShowTheSame) {
  EXPECT_NEAR(ExpectedInformation_bit({At(0.5, 1.0), At(0.5, 1.0)}), 0.0, 1e-9);
}

TEST(ExpectedInformation, IsTheWholeEntropyWhereTheyAreFarApart) {
  EXPECT_NEAR(ExpectedInformation_bit({At(0.7, 0.0), At(0.2, 30.0), At(0.1, 60.0)}), Entropy_bit({0.7, 0.2, 0.1}),
              1e-6);
}

TEST(ExpectedInformation, AgreesWithTheIntegral) {
  // 400 draws a hypothesis of a log ratio that scatters by about a bit: 0.05 bit.
  for (const double apart : {0.5, 1.0, 2.0, 3.0}) {
    EXPECT_NEAR(ExpectedInformation_bit({At(0.4, 0.0), At(0.6, apart)}), ByIntegral(0.4, 0.0, 1.0, apart, 1.0),
                0.05)
        << apart;
  }
  EXPECT_NEAR(ExpectedInformation_bit({At(0.5, 0.0), At(0.5, 2.0, 3.0)}),
              ByIntegral(0.5, 0.0, 1.0, 2.0, std::sqrt(10.0)), 0.05);
}

TEST(ExpectedInformation, IsSmallWhereTheRivalCanBeFittedToTheSame) {
  // Both sizes unknown along the direction in which they differ: the readings fit either.
  const double known = ExpectedInformation_bit({At(0.5, 0.0), At(0.5, 4.0)});
  const double unknown = ExpectedInformation_bit({At(0.5, 0.0, 40.0), At(0.5, 4.0, 40.0)});
  EXPECT_GT(known, 0.8);
  EXPECT_LT(unknown, 0.05);
}

}  // namespace
}  // namespace twinbench::investigate
