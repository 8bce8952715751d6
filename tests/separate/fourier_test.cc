#include "twin/separate/fourier.h"

#include <gtest/gtest.h>

#include <complex>

#include "twin/core/stream.h"
#include "twin/core/units.h"

namespace twinbench::separate {
namespace {

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

TEST(Fourier, FindsAWaveInAThousandsOfPointsOfPrimeNumber) {
  const int n = 36007, order = 17;
  Eigen::VectorXcd wave(n);
  for (int i = 0; i < n; ++i) wave[i] = std::polar(1.0, units::turn * double(1LL * order * i % n) / n);
  const Eigen::VectorXcd X = Fourier(n).Forward(wave);
  EXPECT_NEAR(std::abs(X[order]), n, 1e-8);
  EXPECT_LT(std::abs(X[order + 1]), 1e-8);
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
