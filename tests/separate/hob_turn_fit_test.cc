#include <gtest/gtest.h>

#include "tests/separate/hob_bench.h"
#include "twin/benches/hob_transmission/estimators/turn_fit.h"

namespace twinbench::separate::hob {
namespace {

const std::vector<Line> kLines = {{1, 13.0, 0.4}, {2, 1.5, -2.0}, {22, 2.0, 1.1}, {30, 0.5, 3.0}};

/// Angles of one turn at `n` places, shaken by up to `shake` steps; every `leave_out`-th is missing.
Eigen::VectorXd Angles(int n, double shake, int leave_out) {
  Stream stream(3, "angles");
  std::vector<double> angles;
  for (int i = 0; i < n; ++i) {
    const double angle_rad = kTestTurn_rad * (i + shake * (2.0 * stream.Uniform() - 1.0)) / n;
    if (i % leave_out != 1) angles.push_back(angle_rad);
  }
  return Eigen::Map<const Eigen::VectorXd>(angles.data(), std::ssize(angles));
}

Eigen::VectorXd Values(const Eigen::VectorXd& angle_rad) {
  return angle_rad.unaryExpr([](double a) { return 3.0 + ValueOf(kLines, a); });
}

TEST(FitTurn, ReturnsASumOfHarmonicsExactlyWhereverTheSamplesAre) {
  const Eigen::VectorXd angle_rad = Angles(120, 0.4, 7);
  const TurnFit fit = FitTurn(angle_rad, Values(angle_rad), 0.0, 1, 30);
  ASSERT_TRUE(fit.determined);
  for (int k = 1; k <= 30; ++k)
    EXPECT_LT(DistanceArcsec(fit.value[k - 1], CoefficientOf(kLines, k)), 1e-8)
        << k;  // rounding of 3 rad: 1e-10 arcsec
  EXPECT_NEAR(fit.mean_rad, 3.0, 1e-13);
  // Rounding of the sum of squares of values of 13 arcsec: 1e-8 of their root, and some.
  EXPECT_LT(std::sqrt(fit.residual_sum2 / 100), 1e-7 * 13.0 * kArcsec);
}

TEST(FitTurn, StatesTheVarianceTwoOverNOfRegularSamples) {
  const Eigen::VectorXd angle_rad = Angles(100, 0.0, 1000);
  const Eigen::VectorXd all = Eigen::VectorXd::LinSpaced(100, 0.0, kTestTurn_rad * 0.99);
  const TurnFit fit = FitTurn(all, Values(all), 0.0, 1, 40);
  for (const Eigen::Matrix2d& cofactor : fit.cofactor)
    EXPECT_LT((cofactor - 0.02 * Eigen::Matrix2d::Identity()).cwiseAbs().maxCoeff(), 1e-14);  // rounding
  EXPECT_NEAR(fit.inflation, 1.0, 1e-12);
  EXPECT_GT(FitTurn(angle_rad, Values(angle_rad), 0.0, 1, 40).inflation, 1.0);  // one sample is missing
}

/// The same problem with cosines and sines and a plain inverse.
Eigen::MatrixXd PlainInverse(const Eigen::VectorXd& angle_rad, int max_order) {
  Eigen::MatrixXd design(angle_rad.size(), 2 * max_order + 1);
  design.col(0).setOnes();
  for (int k = 1; k <= max_order; ++k) {
    design.col(2 * k - 1) = (k * angle_rad.array()).cos();
    design.col(2 * k) = -(k * angle_rad.array()).sin();
  }
  return (design.transpose() * design).inverse();
}

TEST(FitTurn, StatesTheCovarianceOfIrregularSamples) {
  const Eigen::VectorXd angle_rad = Angles(60, 0.4, 9);
  const TurnFit fit = FitTurn(angle_rad, Values(angle_rad), 0.0, 1, 15);
  const Eigen::MatrixXd expected = PlainInverse(angle_rad, 15);
  for (int k = 1; k <= 15; ++k) {
    const Eigen::Matrix2d block = expected.block<2, 2>(2 * k - 1, 2 * k - 1);
    const Eigen::Matrix2d& stated = fit.cofactor[static_cast<std::size_t>(k - 1)];
    EXPECT_LT((stated - block).norm(), 1e-9 * block.norm()) << k;  // rounding times the condition
  }
}

TEST(FitTurn, FitsTheRampThatItsSamplesWouldShow) {
  // A ramp from -1/2 to 1/2 over the turn has the coefficients j / (pi k).
  const int n = 20000;
  const Eigen::VectorXd angle_rad =
      Eigen::VectorXd::LinSpaced(n, 0.5 * kTestTurn_rad / n, kTestTurn_rad * (1.0 - 0.5 / n));
  const TurnFit fit = FitTurn(angle_rad, Values(angle_rad), 0.5 * kTestTurn_rad, 1, 5);
  for (int k = 1; k <= 5; ++k)
    EXPECT_LT(std::abs(fit.ramp[k - 1] - Complex(0.0, 1.0) / (units::kPi * k)), 1e-6) << k;  // k / n^2 of the sum
}

TEST(FitTurn, IsNotDeterminedByTooFewSamples) {
  const Eigen::VectorXd angle_rad = Angles(61, 0.0, 1000);
  EXPECT_FALSE(FitTurn(angle_rad, Values(angle_rad), 0.0, 1, 30).determined);
}

TEST(FitTurn, SaysHowMuchAGapCosts) {
  const Eigen::VectorXd whole = Eigen::VectorXd::LinSpaced(400, 0.0, kTestTurn_rad * 399.0 / 400.0);
  const auto inflation = [&](int missing) {
    const Eigen::VectorXd rest = whole.head(400 - missing);
    return FitTurn(rest, Values(rest), 0.0, 1, 30).inflation;
  };
  // Gaps well below pi / 30 = 6.7 samples cost little more than their samples, twice that much costs the turn.
  EXPECT_LT(inflation(3), 1.2);
  EXPECT_GT(inflation(40), 4.0);
}

}  // namespace
}  // namespace twinbench::separate::hob
