#include <gtest/gtest.h>

#include "tests/separate/bench.h"
#include "twin/core/linear_algebra.h"

namespace twinbench::separate {
namespace {

void AddNoise(std::vector<Motion>& motions, const Matrix4& cov, Stream& stream) {
  const Vector4 sd = cov.diagonal().cwiseSqrt();
  for (Motion& m : motions) {
    Vector4 z;
    for (int d = 0; d < 4; ++d) z[d] = stream.Normal();
    m.SetValues(m.Values() + sd.cwiseProduct(z));
  }
}

struct Whitened {
  Eigen::MatrixXd map;  // rows: unit-variance combinations of the table's values
};

Whitened Whiten(const Eigen::MatrixXd& cov) {
  // Lengths in 0.1 m, as angles: the covariance has blocks of rad^2 and m^2.
  const auto [values, vectors] = EigenOfSymmetric(cov);
  const double least = 1e-6 * values.maxCoeff();
  const auto kept = (values.array() > least).count();
  const Eigen::VectorXd inverse_root = values.tail(kept).cwiseSqrt().cwiseInverse();
  return {inverse_root.asDiagonal() * vectors.rightCols(kept).transpose()};
}

Eigen::VectorXd Stacked(const TableEstimate& estimate) {
  std::vector<double> all;
  for (const Component c : estimate.components) {
    for (const double v : estimate.value[c]) all.push_back(v);
  }
  return Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

class MonteCarlo : public testing::TestWithParam<Clamping> {};
INSTANTIATE_TEST_SUITE_P(BothWays, MonteCarlo, testing::Values(Clamping::kReclamp, Clamping::kReseat));

TEST_P(MonteCarlo, StatesACovarianceThatMatchesTheScatter) {
  constexpr int kRuns = 200;
  constexpr int n = 12;
  const auto zero = EmptyMotions(n, {0, 1, 4}, 2, ReadingCovariance());
  const Separator separator(zero, Bench(), Options(n, GetParam()));
  const Separation at_zero = separator.Separate(zero);
  const Whitened target = Whiten(at_zero.target.cov.ToDense()), reference = Whiten(at_zero.reference.cov.ToDense());
  Stream stream(21, "test.noise");
  double sum_target = 0.0, sum_reference = 0.0, sum_chi2 = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    auto motions = zero;
    AddNoise(motions, ReadingCovariance(), stream);
    const Separation found = separator.Separate(motions);
    sum_target += (target.map * Stacked(found.target)).squaredNorm();
    sum_reference += (reference.map * Stacked(found.reference)).squaredNorm();
    sum_chi2 += found.chi2.sum();
  }
  const auto expect_mean = [](double sum, double dof) {
    // A chi-squared variable of `dof`, mean of 200: four standard deviations.
    EXPECT_NEAR(sum / kRuns, dof, 4.0 * std::sqrt(2.0 * dof / kRuns));
  };
  expect_mean(sum_target, static_cast<double>(target.map.rows()));
  expect_mean(sum_reference, static_cast<double>(reference.map.rows()));
  expect_mean(sum_chi2, at_zero.dof);  // diagonal covariance: the four add up
}

TEST(Separate, ScalesUncertaintiesWhenTheResidualsExceedTheStatedNoise) {
  Stream stream(22, "test.noise");
  auto motions = EmptyMotions(12, {0, 1, 4}, 2, ReadingCovariance());
  const Vector4 factor(1.0, 3.0, 1.0, 1.0);
  AddNoise(motions, Matrix4(factor.asDiagonal() * ReadingCovariance() * factor.asDiagonal()), stream);
  const Separation found = Separate(motions, Bench(), Options(12, Clamping::kReseat));
  EXPECT_NEAR(found.scale[1], 3.0, 0.9);  // about 20 degrees of freedom: 16 % standard deviation
  EXPECT_EQ(found.scale[0], 1.0);
  ASSERT_EQ(found.notes.size(), 1u);
  EXPECT_NE(found.notes[0].find("ex"), std::string::npos);
}

TEST(Separate, TakesTheResidualScatterWhenNoNoiseIsStated) {
  Stream stream(23, "test.noise");
  auto motions = EmptyMotions(12, {0, 1, 4}, 4, ReadingCovariance());
  const Separation stated = Separate(motions, Bench(), Options(12, Clamping::kReseat));
  AddNoise(motions, ReadingCovariance(), stream);
  for (Motion& m : motions) {
    m.covariance_known = false;
    m.cov.setConstant(kNaN);
  }
  const Separation found = Separate(motions, Bench(), Options(12, Clamping::kReseat));
  for (const Component c : found.target.components) {
    // More than 90 degrees of freedom a motion: 8 % standard deviation, three of them.
    EXPECT_NEAR(found.target.u[c][3] / stated.target.u[c][3], 1.0, 0.25);
  }
}

}  // namespace
}  // namespace twinbench::separate
