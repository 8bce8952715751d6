#include <fstream>

#include "twin/core/linear_algebra.h"

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

/// Least squares as the estimators do it, against NIST's Statistical Reference Datasets for linear regression,
/// whose coefficients and standard deviations are certified to 15 digits.

struct Dataset {
  MatrixXd design;
  VectorXd observed;
  VectorXd coefficient, deviation;  // certified
  double residual = 0.0;            // certified standard deviation
};

std::vector<double> NumbersOf(std::istream& line) {
  std::vector<double> numbers;
  for (double v; line >> v;) numbers.push_back(v);
  return numbers;
}

VectorXd AsVector(const std::vector<double>& numbers) {
  return Eigen::Map<const VectorXd>(numbers.data(), std::ssize(numbers));
}

/// `model polynomial 0 5` are powers 0 to 5 of the only column, `model columns` a constant and all columns.
VectorXd RowOf(const std::string& model, std::vector<double> data) {
  std::istringstream words(model);
  std::string kind;
  int lowest = 0, highest = 0;
  words >> kind >> lowest >> highest;
  data[0] = 1.0;
  if (kind == "columns") return AsVector(data);
  std::vector<double> row;
  for (int power = lowest; power <= highest; ++power) row.push_back(std::pow(data[1], power));
  return AsVector(row);
}

Dataset ReadDataset(const std::string& name) {
  std::ifstream file(std::string(TWINBENCH_TEST_DATA) + "/strd/" + name + ".txt");
  EXPECT_TRUE(file.good()) << name;
  Dataset set;
  std::vector<double> coefficient, deviation, observed;
  std::vector<VectorXd> rows;
  std::string model;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "model") std::getline(words, model);
    if (kind == "residual") words >> set.residual;
    const std::vector<double> numbers = NumbersOf(words);
    if (kind == "coefficient") {
      coefficient.push_back(numbers.at(0));
      deviation.push_back(numbers.at(1));
    }
    if (kind != "data") continue;
    observed.push_back(numbers.at(0));
    rows.push_back(RowOf(model, numbers));
  }
  set.coefficient = AsVector(coefficient);
  set.deviation = AsVector(deviation);
  set.observed = AsVector(observed);
  set.design.resize(std::ssize(rows), set.coefficient.size());
  for (std::size_t r = 0; r < rows.size(); ++r) set.design.row(static_cast<Eigen::Index>(r)) = rows[r];
  return set;
}

/// Digits that agree, the least of all values: log relative error, or absolute where zero is certified. At most 15.
double DigitsOf(const VectorXd& found, const VectorXd& certified) {
  double least = 15.0;
  for (Eigen::Index i = 0; i < found.size(); ++i) {
    const double scale = certified[i] == 0.0 ? 1.0 : std::abs(certified[i]);
    const double error = std::abs(found[i] - certified[i]) / scale;
    if (!(error <= 1.0)) return 0.0;
    if (error > 0.0) least = std::min(least, -std::log10(error));
  }
  return least;
}

/// Standard deviations of the coefficients from the residuals, by the matrix that takes observations to them.
VectorXd DeviationsOf(const Dataset& set, const MatrixXd& from_observed) {
  const VectorXd left = set.observed - set.design * (from_observed * set.observed);
  const double dof = static_cast<double>(set.design.rows() - set.design.cols());
  return std::sqrt(left.squaredNorm() / dof) * from_observed.rowwise().norm();
}

/// Digits that double allows: 16 less the condition of the design (1e15 for Filip, 7e6 of Wampler's powers, which
/// the residuals of Wampler4 and 5 multiply), measured and rounded down to a digit that another compiler may lose.
struct Expected {
  const char* name;
  double by_reflections;      // SolveLeastSquares
  double by_singular_values;  // SolveRanked
  double by_pseudo_inverse;   // PseudoInverseOf: coefficients and standard deviations
  double by_normal_matrix;    // SolveNormal, which squares the condition: what is fitted by it must be well scaled
};

class Strd : public testing::TestWithParam<Expected> {};
INSTANTIATE_TEST_SUITE_P(
    Linear, Strd,
    testing::Values(
        Expected{"norris", 12, 11, 11, 11}, Expected{"pontius", 11, 11, 11, 11}, Expected{"noint1", 14, 14, 14, 14},
        Expected{"noint2", 14, 14, 14, 14}, Expected{"filip", 6.5, 3.5, 6.5, 0}, Expected{"longley", 10, 10, 11, 6},
        Expected{"wampler1", 8, 8, 7.5, 5.5}, Expected{"wampler2", 11, 8, 11, 8},
        Expected{"wampler3", 8, 8, 7.5, 5.5}, Expected{"wampler4", 7.5, 7.5, 7, 5},
        Expected{"wampler5", 6, 5.5, 5.5, 5}),
    [](const auto& test) { return std::string(test.param.name); });

constexpr double kAllSingularValues = 1e-17;

TEST_P(Strd, HasTheCertifiedCoefficientsAndStandardDeviations) {
  const Dataset set = ReadDataset(GetParam().name);
  const MatrixXd& X = set.design;
  const MatrixXd from_observed = PseudoInverseOf(X).topRows(X.cols());
  const NormalSolution normal = SolveNormal(X.transpose() * X, X.transpose() * set.observed);
  EXPECT_GE(DigitsOf(SolveLeastSquares(X, set.observed), set.coefficient), GetParam().by_reflections);
  EXPECT_GE(DigitsOf(SolveRanked(X, set.observed, kAllSingularValues).x, set.coefficient),
            GetParam().by_singular_values);
  EXPECT_GE(DigitsOf(from_observed * set.observed, set.coefficient), GetParam().by_pseudo_inverse);
  EXPECT_GE(DigitsOf(normal.x, set.coefficient), GetParam().by_normal_matrix);
  EXPECT_GE(DigitsOf(DeviationsOf(set, from_observed), set.deviation), GetParam().by_pseudo_inverse);
  const VectorXd left = set.observed - X * (from_observed * set.observed);
  const double residual = std::sqrt(left.squaredNorm() / static_cast<double>(left.size() - set.coefficient.size()));
  EXPECT_GE(DigitsOf(VectorXd::Constant(1, residual), VectorXd::Constant(1, set.residual)),
            GetParam().by_pseudo_inverse);
}

TEST(StrdFilip, IsNoFullRankForEstimatorsThatCutAtABillionth) {
  // SolveRanked as separate/ calls it: powers of up to 3e9 beside ones are to be scaled first, and it says so.
  const Dataset set = ReadDataset("filip");
  EXPECT_LT(SolveRanked(set.design, set.observed, 1e-9).rank, 11);
}

}  // namespace
}  // namespace twinbench
