#include "twin/core/linear_algebra.h"

#include <gtest/gtest.h>

#include <cmath>

namespace twinbench {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

constexpr double kRounding = 1e-13;  // of numbers of size 1 in a few operations

/// Columns 1, t, t^2 at five points.
MatrixXd Parabola() {
  const VectorXd t = VectorXd::LinSpaced(5, -1.0, 1.0);
  MatrixXd a(5, 3);
  a << VectorXd::Ones(5), t, t.cwiseAbs2();
  return a;
}

/// Its last column is the sum of the others.
MatrixXd RankTwo() {
  MatrixXd a = Parabola();
  a.col(2) = a.col(0) + a.col(1);
  return a;
}

TEST(LinearAlgebra, OfManySolutionsItGivesTheShortest) {
  const MatrixXd a = RankTwo();
  const RankedSolution ranked = SolveRanked(a, a.col(2), 1e-9);
  EXPECT_EQ(ranked.rank, 2);
  EXPECT_EQ(SolveRanked(Parabola(), a.col(2), 1e-9).rank, 3);
  EXPECT_LT((a * ranked.x - a.col(2)).norm(), kRounding);
  // (1, 1, 0) and (0, 0, 1) both do; off the null vector (1, 1, -1) they are (1, 1, 2) / 3.
  const VectorXd shortest = Eigen::Vector3d(1.0, 1.0, 2.0) / 3.0;
  EXPECT_LT((ranked.x - shortest).norm(), kRounding);
  const VectorXd right = a.col(2);
  EXPECT_LT((SolveShortest(a, right) - shortest).norm(), kRounding);
  EXPECT_LT((SolveShortest(a, MatrixXd(right)) - shortest).norm(), kRounding);
  EXPECT_LT((GeneralInverseOf(a) * right - shortest).norm(), kRounding);
}

TEST(LinearAlgebra, FindsWhatAMatrixDoesNotSee) {
  const MatrixXd null = NullSpaceOf(RankTwo(), 1e-9);
  ASSERT_EQ(null.cols(), 1);
  EXPECT_NEAR(std::abs(null.col(0).dot(Eigen::Vector3d(1.0, 1.0, -1.0))), std::sqrt(3.0), kRounding);
  EXPECT_EQ(NullSpaceOf(Parabola(), 1e-9).cols(), 0);
  EXPECT_EQ(NullSpaceOf(Parabola().topRows(1), 1e-9).cols(), 2) << "a single row";
}

TEST(LinearAlgebra, SpansAsManyDirectionsAsTheRank) {
  const MatrixXd basis = OrthonormalBasisOf(RankTwo(), 1e-9);
  ASSERT_EQ(basis.cols(), 2);
  EXPECT_LT((basis.transpose() * basis - Eigen::Matrix2d::Identity()).norm(), kRounding);
  EXPECT_LT((RankTwo() - basis * (basis.transpose() * RankTwo())).norm(), kRounding);
}

TEST(LinearAlgebra, WhatLiesBehindTheColumnsIsTheResidual) {
  const VectorXd v = VectorXd::LinSpaced(5, 0.0, 1.0).array().exp();
  const MatrixXd a = Parabola();
  const double left = (v - a * SolveLeastSquares(a, v)).norm();
  EXPECT_NEAR(RotatedByQ(a, v).tail(2).norm(), left, kRounding);
}

TEST(LinearAlgebra, InvertsWhatIsPositiveDefiniteAndNothingElse) {
  const MatrixXd a = Parabola().transpose() * Parabola();
  const MatrixXd one = MatrixXd::Identity(3, 3);
  EXPECT_LT((InverseOfPositive(a, 1e-9).value() * a - one).norm(), kRounding);
  const MatrixXd factor = InverseCholeskyFactor(a).value();
  EXPECT_LT((factor.transpose() * factor * a - one).norm(), kRounding);
  const VectorXd b = Eigen::Vector3d(1.0, -2.0, 0.5);
  const NormalSolution solved = SolveNormal(a, b);
  EXPECT_LT((a * solved.x - b).norm(), kRounding);
  EXPECT_LT((solved.inverse * a - one).norm(), kRounding);
  EXPECT_LT((SolveSquare(a, b) - solved.x).norm(), kRounding);
  EXPECT_FALSE(InverseOfPositive(a, 0.9).has_value()) << "worse than the condition asked for";
  EXPECT_FALSE(InverseOfPositive(-a, 1e-9).has_value());
  EXPECT_FALSE(InverseCholeskyFactor(MatrixXd::Zero(2, 2)).has_value());
}

TEST(LinearAlgebra, KnowsTheEigenvaluesOfAVibratingChain) {
  // Two masses between three springs: 1 and 3.
  const MatrixXd a = (Eigen::Matrix2d() << 2.0, -1.0, -1.0, 2.0).finished();
  const SymmetricEigen eigen = EigenOfSymmetric(a);
  EXPECT_LT((eigen.values - Eigen::Vector2d(1.0, 3.0)).norm(), kRounding);
  EXPECT_LT((a * eigen.vectors - eigen.vectors * eigen.values.asDiagonal()).norm(), kRounding);
  EXPECT_LT((EigenvaluesOfSymmetric(a) - eigen.values).norm(), kRounding);
}

TEST(LinearAlgebra, FindsTheRootOfACovarianceOfAnyUnitsAndRank) {
  // A length in metres, its double in nanometres, and what is known without doubt.
  const MatrixXd along = (MatrixXd(3, 1) << 3.0, 6e9, 0.0).finished();
  const MatrixXd cov = along * along.transpose(), root = CovarianceRootOf(cov), back = root * root.transpose();
  EXPECT_NEAR(back(0, 0), 9.0, kRounding);
  EXPECT_NEAR(back(0, 1) / 18e9, 1.0, kRounding);
  EXPECT_NEAR(back(1, 1) / 36e18, 1.0, kRounding);
  EXPECT_EQ(back.row(2).norm(), 0.0);
}

/// Eigen reads what is not its own where there are no columns, and says rank 0 of what is not finite.
TEST(LinearAlgebra, DecomposesNeitherWhatIsNotFiniteNorNothing) {
  MatrixXd bad = Parabola(), square = bad.transpose() * bad;
  bad(2, 1) = std::nan("");
  square(0, 0) = INFINITY;
  const MatrixXd b = MatrixXd::Ones(5, 2), none(5, 0);
  for (const MatrixXd& answer :
       {SolveRanked(bad, b, 1e-9).x, SolveShortest(bad, b), SolveLeastSquares(bad, b), MatrixXd(SolveSquare(square, b.topRows(3)))}) {
    EXPECT_EQ(answer.rows(), 3);
    EXPECT_TRUE(answer.array().isNaN().all()) << answer;
  }
  for (const MatrixXd& answer : {GeneralInverseOf(bad), PseudoInverseOf(bad), NullSpaceOf(bad, 1e-9), OrthonormalBasisOf(bad, 1e-9),
                                 EigenOfSymmetric(square).vectors, MatrixXd(EigenvaluesOfSymmetric(square)),
                                 SolveNormal(square, b.col(0).head(3)).inverse, CovarianceRootOf(square)})
    EXPECT_TRUE(answer.array().isNaN().all()) << answer;
  EXPECT_FALSE(InverseOfPositive(square, 0.0).has_value());
  EXPECT_FALSE(InverseCholeskyFactor(square).has_value());
  EXPECT_EQ(SolveRanked(none, b, 1e-9).x.rows(), 0);
  EXPECT_EQ(SolveLeastSquares(none, b).rows(), 0);
  EXPECT_EQ(SolveShortest(none, b).rows(), 0);
  EXPECT_EQ(OrthonormalBasisOf(none, 1e-9).cols(), 0);
  EXPECT_EQ(EigenvaluesOfSymmetric(MatrixXd(0, 0)).size(), 0);
}

}  // namespace
}  // namespace twinbench
