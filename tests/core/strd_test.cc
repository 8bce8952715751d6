#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "twin/core/linear_algebra.h"

/// Least squares as the estimators do it, against NIST's Statistical Reference Datasets for linear regression,
/// whose coefficients and standard deviations are certified to 15 digits.
namespace twinbench {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

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
VectorXd RowOf(const std::string& model, const std::vector<double>& data) {
  std::istringstream words(model);
  std::string kind;
  int lowest = 0, highest = 0;
  words >> kind >> lowest >> highest;
  std::vector<double> row;
  if (kind == "columns") {
    row = data;
    row[0] = 1.0;
  } else {
    for (int power = lowest; power <= highest; ++power) row.push_back(std::pow(data[1], power));
  }
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
