#include <complex>

#include "twin/core/stream.h"
#include "twin/core/units.h"
#include "twin/separate/curve_covariance.h"
#include "twin/separate/fourier.h"
#include "twin/separate/shift_separation.h"
#include "twin/separate/shift_transfer.h"

namespace twinbench::separate::shifts {
namespace {

ShiftSet Even(int n, const std::vector<int>& shifts) {
  return {n, shifts, std::vector<double>(shifts.size(), 1.0)};
}

TEST(Transfers, WeighSetUps) {
  // Two set-ups of weights 3 and 1: |3 + z|^2 = 10 + 6 cos.
  const auto transfers = Transfers({12, {0, 1}, {3.0, 1.0}});
  for (int k = 1; k <= 6; ++k) {
    const double determinant = 16.0 - 10.0 - 6.0 * std::cos(units::turn * k / 12);
    EXPECT_NEAR(transfers[static_cast<std::size_t>(k)].determinant, determinant, 1e-13);
  }
}

TEST(LostHarmonics, AreTheMultiplesThatAllShiftsShowAlike) {
  EXPECT_EQ(LostHarmonics(Even(12, {0, 1, 4})), std::vector<int>{});
  EXPECT_EQ(LostHarmonics(Even(12, {0, 4, 10})), std::vector<int>{6});
  EXPECT_EQ(LostHarmonics(Even(36, {5, 14, -4})), (std::vector<int>{4, 8, 12, 16}));
  EXPECT_EQ(LostHarmonics(Even(5, {2, 2})), (std::vector<int>{1, 2}));
}

TEST(Transfers, RefuseWeightsThatAreNone) {
  EXPECT_THROW(Transfers({12, {0, 1}, {1.0, 0.0}}), std::logic_error);
  EXPECT_THROW(Transfers({12, {0, 1}, {1.0}}), std::logic_error);
}

// What a fit of few stops does not show: turntable_shift_fit_test.cc holds those against dense matrices.

using Eigen::MatrixXd, Eigen::VectorXd;

/// Spread over so many decades; 0 for this part of the readings.
MatrixXd WeightsOf(int n, Eigen::Index setups, double missing, double decades) {
  Stream random(5, "test.weights");
  MatrixXd weight(n, setups);
  for (double& w : weight.reshaped()) {
    w = std::pow(10.0, decades * (random.Uniform() - 0.5));
    if (random.Uniform() < missing) w = 0.0;
  }
  return weight;
}

MatrixXd NormalValues(Eigen::Index rows, Eigen::Index cols) {
  Stream random(7, "test.values");
  MatrixXd values(rows, cols);
  for (double& v : values.reshaped()) v = random.Normal();
  return values;
}

/// What two curves (columns) show at shifts, each set-up with a constant.
MatrixXd ReadingsOf(const MatrixXd& truth, const std::vector<int>& shifts) {
  const Eigen::Index n = truth.rows();
  MatrixXd values(n, std::ssize(shifts));
  for (Eigen::Index j = 0; j < values.cols(); ++j) {
    const int shift = shifts[static_cast<std::size_t>(j)];
    for (Eigen::Index i = 0; i < n; ++i)
      values(i, j) = truth(i, 0) + truth((i + shift) % n, 1) + 10.0 * static_cast<double>(j);
  }
  return values;
}

void ExpectCurves(const ShiftSolution& found, const MatrixXd& truth) {
  EXPECT_TRUE(found.convergence.converged);
  for (const int curve : {0, 1}) {
    const VectorXd error = found.unknowns.segment(curve * truth.rows(), truth.rows()) - truth.col(curve);
    EXPECT_LT((error.array() - error.mean()).abs().maxCoeff(), 1e-11) << curve;
  }
}

// 1e-16 times readings of 40 and a noise gain near 1.
TEST(ShiftSeparation, ReturnsTwoCurvesOfThousandsOfStopsWithGaps) {
  const std::vector<int> shifts = {0, 1, 61, 411, 1203};
  const MatrixXd truth = NormalValues(3600, 2), weight = WeightsOf(3600, 5, 0.02, 1.0);
  const MatrixXd values = (weight.array() == 0.0).select(kNaN, ReadingsOf(truth, shifts));
  const ShiftSolution found = ShiftSeparation(shifts, weight).Solve(values);
  ExpectCurves(found, truth);
  EXPECT_LT(found.convergence.iterations, 150);
  EXPECT_EQ(found.residuals.array().isNaN().count(), (weight.array() == 0.0).count());
}

// The first harmonic has 1 / sin(pi / n) = 5700 times the noise of the best: 1e-16 times that, summed over harmonics.
TEST(ShiftSeparation, SolvesTwoSetUpsOfManyStopsToTheLastDigitsThatThereAre) {
  const MatrixXd truth = NormalValues(18000, 2);
  ExpectCurves(ShiftSeparation({0, 1}, MatrixXd::Ones(18000, 2)).Solve(ReadingsOf(truth, {0, 1})), truth);
}

// Circles of opposite waves leave next to nothing to fit, and its gradient is rounding: steps along it led to
// numbers without bound, or to residuals of their own. 1e-16 times readings of 100.
TEST(ShiftSeparation, TakesNoStepsWhereOnlyRoundingIsLeftToFit) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Stream random(seed, "test.opposite");
    MatrixXd values(48, 2);
    for (Eigen::Index i = 0; i < 48; ++i)
      for (Eigen::Index j = 0; j < 2; ++j)
        values(i, j) = (j == 0 ? 100.0 : -100.0) * std::cos(units::turn * static_cast<double>(i) / 48.0) + 0.1 * random.Normal();
    MatrixXd left = values.colwise() - values.rowwise().mean();
    left.rowwise() -= left.colwise().mean();
    const ShiftSolution found = ShiftSeparation({0, 0}, MatrixXd::Ones(48, 2)).Solve(values);
    EXPECT_LT((found.residuals - left).cwiseAbs().maxCoeff(), 1e-11) << seed;
    EXPECT_LT(found.unknowns.cwiseAbs().maxCoeff(), 1.0) << seed;
  }
}

TEST(ShiftSeparation, SaysSoWhereItHasNotConverged) {
  const std::vector<int> shifts = {0, 1, 7};
  const MatrixXd weight = WeightsOf(60, 3, 0.1, 4.0), values = NormalValues(60, 3);
  const ShiftSolution few = ShiftSeparation(shifts, weight, 2).Solve(values);
  EXPECT_FALSE(few.convergence.converged);
  EXPECT_GT(few.convergence.relative_error, 1e-12);
  EXPECT_TRUE(ShiftSeparation(shifts, weight).Solve(values).convergence.converged);
}

TEST(ShiftSeparation, RefusesWhatIsNoProblem) {
  EXPECT_THROW(ShiftSeparation({0, 1}, MatrixXd::Ones(12, 3)), std::logic_error);
  EXPECT_THROW(ShiftSeparation({0, 1}, MatrixXd::Zero(12, 2)), std::logic_error);
  EXPECT_THROW(ShiftSeparation({0, 1}, -MatrixXd::Ones(12, 2)), std::logic_error);
  const ShiftSeparation separation({0, 1}, MatrixXd::Ones(12, 2));
  EXPECT_THROW(separation.Solve(MatrixXd::Zero(11, 2)), std::logic_error);
}

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
}  // namespace twinbench::separate::shifts
