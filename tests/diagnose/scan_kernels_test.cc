#include "twin/diagnose/engine/scan_kernels.h"

#include <gtest/gtest.h>

#include <cmath>

#include "twin/core/stream.h"
#include "twin/diagnose/engine/vector_math.h"

namespace twinbench::diagnose {
namespace {

Eigen::MatrixXd NormalMatrix(Eigen::Index rows, Eigen::Index columns) {
  Stream stream(3, "scan_kernels");
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return stream.Normal(); });
}

TEST(ScanKernels, ExponentialIsThatOfTheMathematicsLibrary) {
  for (double x = -699.0; x <= 0.0; x += 0.0917) EXPECT_NEAR(ExpOfNegative(x) / std::exp(x), 1.0, 1e-14) << x;
  EXPECT_EQ(ExpOfNegative(0.0), 1.0);
  EXPECT_LT(ExpOfNegative(-1e300), 1e-300);
}

TEST(ScanKernels, LogarithmIsThatOfTheMathematicsLibrary) {
  for (double x = 1e-12; x < 1e6; x *= 1.0173)
    EXPECT_NEAR(LogOfPositive(x), std::log(x), 2e-15 * (1.0 + std::abs(std::log(x)))) << x;
  for (const double x : {1.0 - 1e-9, 1.0 + 1e-9, 1.0 - 0x1p-53})
    EXPECT_NEAR(LogOfPositive(x) / std::log(x), 1.0, 1e-12) << x;
  EXPECT_EQ(LogOfPositive(1.0), 0.0);
}

TEST(ScanKernels, ProductIsThatOfMatricesOfAnySize) {
  for (const Eigen::Index rows : {1, 7, 8, 9, 40}) {
    const Eigen::MatrixXd A = NormalMatrix(rows, 5), B = NormalMatrix(rows, 11);
    const Eigen::MatrixXd product = TransposedProduct(A, B), expected = A.transpose() * B;
    EXPECT_LT((product - expected).cwiseAbs().maxCoeff(), 1e-13) << rows;
  }
}

TEST(ScanKernels, ProductOfPartOfAMatrixReadsThatPartOnly) {
  const Eigen::MatrixXd A = NormalMatrix(20, 6), B = NormalMatrix(13, 4);
  const Eigen::MatrixXd product = TransposedProduct(A.block(2, 1, 13, 3), B);
  EXPECT_LT((product - A.block(2, 1, 13, 3).transpose() * B).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(ScanKernels, MeanOfExponentialsDoesNotOverflow) {
  const Eigen::ArrayXd first{{-1000.0, 900.0, 3.0}}, second{{-1001.0, 900.0, -500.0}};
  LogMean mean(3);
  mean.Add(first);
  mean.Add(second);
  const Eigen::ArrayXd value = mean.Value();
  EXPECT_NEAR(value[0], -1000.0 + std::log(0.5 * (1.0 + std::exp(-1.0))), 1e-12);
  EXPECT_NEAR(value[1], 900.0, 1e-12);
  EXPECT_NEAR(value[2], 3.0 - std::log(2.0), 1e-12);
}

TEST(ScanKernels, LogBayesFactorIsItsFormula) {
  const RunsByRow c2 = NormalMatrix(2, 9).array().square();
  const Eigen::VectorXd weight{{0.4, 0.9}};
  const Eigen::ArrayXd power = Eigen::ArrayXd::LinSpaced(9, 0.5, 30.0);  // the first leave nothing
  Eigen::ArrayXd log_bayes;
  LogBayesOf(weight, c2, power, 0.7, 25.0, log_bayes);
  for (Eigen::Index k = 0; k < 9; ++k) {
    const double left = 1.0 - (0.4 * c2(0, k) + 0.9 * c2(1, k)) / power[k];
    EXPECT_NEAR(log_bayes[k], -0.7 - 25.0 * std::log(std::max(left, 1e-12)), 1e-11) << k;
  }
}

}  // namespace
}  // namespace twinbench::diagnose
