#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "twin/core/stream.h"
#include "twin/core/units.h"
#include "twin/separate/curve_covariance.h"
#include "twin/separate/fourier.h"

namespace twinbench::separate {
namespace {

Eigen::MatrixXd Random(Eigen::Index rows, Eigen::Index cols, Stream& stream) {
  return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return stream.Normal(); });
}

/// Two curves at n positions: circulant, with something added, taken off and on the diagonal.
CurveCovariance OfTwoCurves(Eigen::Index n, Stream& stream) {
  Eigen::MatrixXd lags = Random(n, 4, stream);
  for (Eigen::Index i = 1; i < n; ++i) {  // a curve with itself: the same either way round
    for (const Eigen::Index c : {0, 3}) lags(i, c) = lags(n - i, c);
  }
  CurveCovariance covariance = CurveCovariance::Circulant(lags, 2);
  covariance.AddProduct(Random(2 * n, 2, stream));
  covariance.SubtractProduct(Random(2 * n, 1, stream));
  covariance.AddVariance(n + 2, 0.7);
  return covariance;
}

TEST(CurveCovarianceOrderSums, AreTheDoubleSumsOverThePositions) {
  Stream stream(8, "test.order_sums");
  for (const Eigen::Index n : {7, 12}) {
    const CurveCovariance covariance = OfTwoCurves(n, stream);
    const Eigen::MatrixXd dense = covariance.ToDense();
    for (const Eigen::Index curve : {0, 1}) {
      const Eigen::VectorXd sums = covariance.OrderSums(curve, n), of_dense = CurveCovariance::Dense(dense).OrderSums(curve, n);
      ASSERT_EQ(sums.size(), n / 2 + 1);
      for (Eigen::Index k = 0; k < sums.size(); ++k) {
        double expected = 0.0;
        for (Eigen::Index i = 0; i < n; ++i) {
          for (Eigen::Index j = 0; j < n; ++j)
            expected += dense(curve * n + i, curve * n + j) * std::cos(units::turn * static_cast<double>(k * (i - j)) / static_cast<double>(n));
        }
        EXPECT_NEAR(sums[k], expected, 1e-11) << n << " order " << k;
        EXPECT_NEAR(of_dense[k], expected, 1e-11) << n << " order " << k;
      }
    }
  }
}

TEST(CurveCovariance, HoldsLagsProductsAndVariances) {
  Eigen::MatrixXd lags(3, 4);  // two curves at three positions
  lags << 4.0, 0.5, 0.5, 6.0,  //
      1.0, 0.2, 0.3, 2.0,      //
      1.0, 0.3, 0.2, 2.0;
  CurveCovariance cov = CurveCovariance::Circulant(lags, 2) * 4.0;
  EXPECT_EQ(cov(0, 1), 4.0);
  EXPECT_EQ(cov(1, 5), 4.0 * 0.2);  // curve 0 at 1, curve 1 at 2
  EXPECT_EQ(cov(5, 1), cov(1, 5));
  cov.AddProduct(Eigen::VectorXd::LinSpaced(6, 1.0, 6.0));
  cov.AddVariance(2, 7.0);
  EXPECT_EQ(cov(2, 2), 16.0 + 9.0 + 7.0);
  EXPECT_EQ((cov * 4.0)(0, 1), 4.0 * (4.0 + 2.0));
  EXPECT_EQ(cov.diagonal(), cov.ToDense().diagonal());
  EXPECT_EQ(cov.ToDense(), cov.ToDense().transpose());
}

Eigen::VectorXcd RandomValues(int n) {
  Stream random(1, "test.fourier");
  Eigen::VectorXcd x(n);
  for (auto& v : x) v = {random.Normal(), random.Normal()};
  return x;
}

Eigen::VectorXcd Defined(const Eigen::VectorXcd& x) {
  const auto n = x.size();
  Eigen::VectorXcd X = Eigen::VectorXcd::Zero(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    for (Eigen::Index i = 0; i < n; ++i)
      X[k] += x[i] * std::polar(1.0, -units::turn * double(k * i % n) / double(n));
  }
  return X;
}

TEST(Fourier, IsTheDefinitionForEveryKindOfLength) {
  // 67 and 509 are primes that become a convolution, 134 = 2 * 67; the others go by their factors.
  for (const int n : {1, 2, 3, 36, 61, 67, 134, 360, 509}) {
    const Eigen::VectorXcd x = RandomValues(n);
    const Fourier fourier(n);
    // Rounding: 1e-16 sqrt(n) a value, a few times.
    EXPECT_LT((fourier.Forward(x) - Defined(x)).cwiseAbs().maxCoeff(), 2e-13) << n;
    EXPECT_LT((fourier.Backward(fourier.Forward(x)) / n - x).cwiseAbs().maxCoeff(), 1e-14) << n;
  }
}

TEST(LargestPrimeFactor, IsThat) {
  EXPECT_EQ(LargestPrimeFactor(1), 1);
  EXPECT_EQ(LargestPrimeFactor(36000), 5);
  EXPECT_EQ(LargestPrimeFactor(2 * 509), 509);
  EXPECT_EQ(LargestPrimeFactor(36007), 36007);
}

TEST(Fourier, RefusesNoPointsAndAnotherLength) {
  EXPECT_THROW(Fourier(0), std::logic_error);
  EXPECT_THROW(Fourier(4).Forward(Eigen::VectorXcd::Zero(5)), std::logic_error);
}

}  // namespace
}  // namespace twinbench::separate
