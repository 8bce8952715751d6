#include "twin/separate/shift_separation.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "twin/core/stream.h"

namespace twinbench::separate::shifts {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

struct Problem {
  const char* name = "";
  int n = 0;
  std::vector<int> shifts = {};
  Free free = Free::kConstant;
  double missing = 0.0;         // part of the readings
  double weight_decades = 0.0;  // weights are spread over so many
  std::vector<int> rows = {};

  int Curves() const { return 1 + ShiftSet{n, shifts, {}, rows}.Rows(); }
  int Row(int setup) const { return rows.empty() ? 0 : rows[static_cast<std::size_t>(setup)]; }
};

MatrixXd WeightsOf(const Problem& p) {
  Stream random(5, p.name);
  MatrixXd weight(p.n, std::ssize(p.shifts));
  for (double& w : weight.reshaped()) {
    w = std::pow(10.0, p.weight_decades * (random.Uniform() - 0.5));
    if (random.Uniform() < p.missing) w = 0.0;
  }
  return weight;
}

MatrixXd NormalValues(Eigen::Index rows, Eigen::Index cols) {
  Stream random(7, "test.values");
  MatrixXd values(rows, cols);
  for (double& v : values.reshaped()) v = random.Normal();
  return values;
}

/// What two curves (columns) show at shifts.
MatrixXd ReadingsOf(const MatrixXd& truth, const std::vector<int>& shifts) {
  const Eigen::Index n = truth.rows();
  MatrixXd values(n, std::ssize(shifts));
  for (Eigen::Index j = 0; j < values.cols(); ++j) {
    const int shift = shifts[static_cast<std::size_t>(j)];
    for (Eigen::Index i = 0; i < n; ++i) values(i, j) = truth(i, 0) + truth((i + shift) % n, 1);
  }
  return values;
}

/// The same problem as one dense matrix, and what of its unknowns is estimable by its singular values: nothing here
/// knows of harmonics, classes of stops or Fourier's transform.
class Dense {
 public:
  Dense(const Problem& p, const MatrixXd& weight) : n_(p.n), values_(p.Curves() * p.n) {
    const int terms = TermsOf(p.free), setups = static_cast<int>(p.shifts.size());
    design_ = MatrixXd::Zero(0, values_ + terms * setups);
    for (int j = 0; j < setups; ++j) {
      for (int i = 0; i < n_; ++i) {
        if (weight(i, j) == 0.0) continue;
        rows_.push_back({i, j});
        root_.conservativeResize(std::ssize(rows_));
        root_[root_.size() - 1] = std::sqrt(weight(i, j));
        design_.conservativeResize(std::ssize(rows_), Eigen::NoChange);
        auto row = design_.bottomRows(1);
        row.setZero();
        row(0, i) = 1.0;
        const int place = ((i + p.shifts[static_cast<std::size_t>(j)]) % n_ + n_) % n_;
        row(0, (1 + p.Row(j)) * n_ + place) = 1.0;
        if (terms > 0) row(0, values_ + terms * j) = 1.0;
        if (terms > 1) row(0, values_ + terms * j + 1) = 2.0 * i / (n_ - 1.0) - 1.0;
      }
    }
    const Eigen::JacobiSVD<MatrixXd> svd(design_, Eigen::ComputeThinU | Eigen::ComputeFullV);
    rank_ = (svd.singularValues().array() > 1e-9 * svd.singularValues()[0]).count();
    null_ = svd.matrixV().rightCols(design_.cols() - rank_);
  }

  VectorXd Solve(const MatrixXd& values) const {
    const VectorXd right = root_.cwiseProduct(Rows(values));
    const MatrixXd weighted = root_.asDiagonal() * design_;
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> qr(weighted);
    qr.setThreshold(1e-9);
    VectorXd x = qr.solve(right);
    x += qr.solve(right - weighted * x);  // one step of refinement
    return x;
  }
  VectorXd Residuals(const MatrixXd& values) const { return Rows(values) - design_ * Solve(values); }
  MatrixXd Inverse() const {
    const MatrixXd weighted = root_.asDiagonal() * design_;
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> qr(weighted);
    qr.setThreshold(1e-9);
    const MatrixXd pseudo = qr.pseudoInverse();
    return pseudo * pseudo.transpose();
  }
  /// Projector on what is estimable of one curve, over the stops that are `used`.
  MatrixXd Projector(Curve curve, const std::vector<bool>& used) const {
    const auto size = static_cast<int>(used.size());
    MatrixXd part = null_.middleRows(curve == Curve::kA ? 0 : n_, size), unit = MatrixXd::Identity(size, size);
    for (int i = 0; i < size; ++i) {
      if (used[static_cast<std::size_t>(i)]) continue;
      part.row(i).setZero();
      unit(i, i) = 0.0;
    }
    Eigen::ColPivHouseholderQR<MatrixXd> qr(part);
    qr.setThreshold(1e-7);
    const MatrixXd q = qr.householderQ() * MatrixXd::Identity(size, qr.rank());
    return unit - q * q.transpose();
  }
  VectorXd Rows(const MatrixXd& values) const {
    VectorXd rows(std::ssize(rows_));
    for (std::size_t k = 0; k < rows_.size(); ++k)
      rows[static_cast<Eigen::Index>(k)] = values(rows_[k].first, rows_[k].second);
    return rows;
  }
  double dof() const { return static_cast<double>(design_.rows() - rank_); }

 private:
  int n_, values_;
  std::vector<std::pair<int, int>> rows_;
  VectorXd root_;
  MatrixXd design_, null_;
  Eigen::Index rank_ = 0;
};

ShiftSeparation SeparationOf(const Problem& p, const MatrixXd& weight) {
  return {p.shifts, p.free, weight, 2000, p.rows};
}

int SizeOf(const Problem& p, Curve curve) {
  return curve == Curve::kA ? p.n : (p.Curves() - 1) * p.n;
}

std::vector<bool> DeterminedOf(const ShiftSeparation& separation, Curve curve, int size) {
  std::vector<bool> determined;
  for (int i = 0; i < size; ++i) determined.push_back(separation.IsDetermined(curve, i));
  return determined;
}

VectorXd ZeroForNaN(const VectorXd& values) {
  return values.array().isNaN().select(0.0, values);
}

void ExpectTheDenseSolution(const Problem& p, const MatrixXd& weight) {
  const ShiftSeparation separation = SeparationOf(p, weight);
  const Dense dense(p, weight);
  const MatrixXd values = NormalValues(p.n, weight.cols());
  const ShiftSolution found = separation.Solve(values);
  EXPECT_TRUE(found.convergence.converged) << p.name << ' ' << found.convergence.relative_error;
  EXPECT_TRUE(separation.search_converged()) << p.name;
  EXPECT_EQ(separation.dof(), dense.dof()) << p.name;
  const VectorXd x = dense.Solve(values);
  for (const Curve curve : {Curve::kA, Curve::kB}) {
    const int size = SizeOf(p, curve);
    const MatrixXd projector = dense.Projector(curve, DeterminedOf(separation, curve, size));
    const VectorXd expected = projector * x.segment(curve == Curve::kA ? 0 : p.n, size);
    const VectorXd value = ZeroForNaN(curve == Curve::kA ? found.a : found.b);
    EXPECT_LT((value - expected).cwiseAbs().maxCoeff(), 1e-10) << p.name;  // asked for by the task
  }
  const VectorXd residuals = dense.Rows(found.residuals);
  EXPECT_LT((residuals - dense.Residuals(values)).cwiseAbs().maxCoeff(), 1e-10) << p.name;
}

class AgainstDense : public testing::TestWithParam<Problem> {};
INSTANTIATE_TEST_SUITE_P(
    Problems, AgainstDense,
    testing::Values(Problem{"even", 36, {0, 1, 7, 11}}, Problem{"two", 12, {0, 1}},
                    Problem{"nothing_free", 12, {0, 1, 4}, Free::kNothing},
                    Problem{"affine", 20, {0, 1, 4, 9}, Free::kAffine},
                    Problem{"affine_of_two", 12, {0, 5}, Free::kAffine},
                    Problem{"weights", 24, {0, 1, 7, 11}, Free::kConstant, 0.0, 3.0},
                    Problem{"gaps", 24, {0, 1, 7, 11}, Free::kConstant, 0.15},
                    Problem{"gaps_and_weights", 30, {0, 1, 7, 11, 19}, Free::kConstant, 0.1, 2.0},
                    Problem{"affine_gaps", 25, {0, 1, 7, 11}, Free::kAffine, 0.1, 1.0},
                    Problem{"lost_harmonics", 24, {0, 4, 10, 14}, Free::kConstant, 0.1, 1.0},
                    Problem{"lost_and_affine", 24, {0, 4, 10, 14}, Free::kAffine},
                    Problem{"prime", 67, {3, -1, 75, 75}, Free::kConstant, 0.05, 1.0},
                    Problem{"no_shift", 9, {2, 2, 11}, Free::kConstant, 0.1, 1.0},
                    Problem{"rows", 15, {0, 1, 3, 4}, Free::kConstant, 0.0, 0.0, {0, 0, 1, 1}},
                    Problem{"rows_gaps", 18, {0, 1, 7, 3, 5, 9}, Free::kConstant, 0.08, 1.0, {0, 0, 0, 1, 2, 2}}),
    [](const auto& test) { return std::string(test.param.name); });

TEST_P(AgainstDense, GivesTheSameCurvesResidualsAndDegreesOfFreedom) {
  ExpectTheDenseSolution(GetParam(), WeightsOf(GetParam()));
}

TEST_P(AgainstDense, GivesTheSameCovariance) {
  const Problem& p = GetParam();
  const MatrixXd weight = WeightsOf(p);
  const ShiftSeparation separation = SeparationOf(p, weight);
  const Dense dense(p, weight);
  const int of_b = SizeOf(p, Curve::kB), all = p.n + of_b;
  MatrixXd both = MatrixXd::Zero(all, all);
  both.topLeftCorner(p.n, p.n) = dense.Projector(Curve::kA, DeterminedOf(separation, Curve::kA, p.n));
  both.bottomRightCorner(of_b, of_b) = dense.Projector(Curve::kB, DeterminedOf(separation, Curve::kB, of_b));
  const MatrixXd expected = both * dense.Inverse().topLeftCorner(all, all) * both;
  for (const int stop : {0, p.n / 2, p.n - 1}) {
    for (const Curve curve : {Curve::kA, Curve::kB}) {
      if (!separation.IsDetermined(curve, stop)) continue;
      const VectorXd found = ZeroForNaN(separation.CovarianceWith(curve, stop));
      const VectorXd column = expected.col(curve == Curve::kA ? stop : p.n + stop);
      EXPECT_LT((found - column).cwiseAbs().maxCoeff(), 1e-10) << stop;  // variances are about one
    }
  }
}

TEST(ShiftSeparation, HasCovariancesByLagAsTheClosedFormSays) {
  const ShiftSeparation separation({0, 1, 7, 11}, Free::kConstant, MatrixXd::Constant(36, 4, 4.0));
  const LagCovariance lags = separation.Lags();
  const ShiftSet set{36, {0, 1, 7, 11}, {4.0, 4.0, 4.0, 4.0}};
  EXPECT_NEAR(lags.aa[0], ValueVariance(set), 1e-13);
  EXPECT_NEAR(lags.aa[5], separation.CovarianceWith(Curve::kB, 20)[36 + 25], 1e-13);
  EXPECT_NEAR(lags.ab[5], separation.CovarianceWith(Curve::kA, 20)[36 + 25], 1e-13);
}

TEST(ShiftSeparation, LosesWhatATornRingLeavesOpen) {
  // Two set-ups close one ring of n links; without one link its slope, which is the set-ups' difference, is free.
  MatrixXd weight = MatrixXd::Ones(12, 2);
  weight(4, 0) = 0.0;
  const ShiftSeparation separation({0, 1}, Free::kConstant, weight);
  int lost = 0;
  for (int i = 0; i < 12; ++i) lost += separation.IsDetermined(Curve::kA, i) ? 0 : 1;
  EXPECT_GE(lost, 11);  // one may lie where the slope crosses the median
  EXPECT_EQ(separation.dof(), 0.0);
}

TEST(ShiftSeparation, LosesOnlyTheStopThatIsCutOff) {
  // All that reads a(6) meets places of b that nothing else reads: both hang on nothing.
  const int n = 12;
  const std::vector<int> shifts = {0, 1, 4};
  MatrixXd weight = MatrixXd::Ones(n, 3);
  const int stop = 6, place = 7;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < n; ++i) {
      const bool here = i == stop, there = (i + shifts[static_cast<std::size_t>(j)]) % n == place;
      if (here != there) weight(i, j) = 0.0;
    }
  }
  const ShiftSeparation separation(shifts, Free::kConstant, weight);
  for (int i = 0; i < n; ++i) {
    EXPECT_EQ(separation.IsDetermined(Curve::kA, i), i != stop) << i;
    EXPECT_EQ(separation.IsDetermined(Curve::kB, i), i != place) << i;
  }
  ExpectTheDenseSolution({"cut", n, shifts}, weight);
}

TEST(ShiftSeparation, LeavesOutStopsThatNobodyVisited) {
  MatrixXd weight = MatrixXd::Ones(12, 3);
  weight.row(5).setZero();
  const ShiftSeparation separation({0, 1, 4}, Free::kConstant, weight);
  EXPECT_FALSE(separation.IsDetermined(Curve::kA, 5));
  EXPECT_TRUE(separation.IsDetermined(Curve::kB, 5));
  EXPECT_TRUE(std::isnan(separation.Solve(MatrixXd::Zero(12, 3)).a[5]));
  ExpectTheDenseSolution({"unvisited", 12, {0, 1, 4}}, weight);
}

TEST(ShiftSeparation, HearsNothingFromASetUpOfFewReadings) {
  MatrixXd weight = MatrixXd::Ones(12, 4);
  weight.col(3).setZero();
  weight(3, 3) = weight(8, 3) = 1.0;
  const MatrixXd values = NormalValues(12, 4);
  const ShiftSolution with = ShiftSeparation({0, 1, 4, 6}, Free::kAffine, weight).Solve(values);
  const ShiftSolution without =
      ShiftSeparation({0, 1, 4}, Free::kAffine, MatrixXd::Ones(12, 3)).Solve(values.leftCols(3));
  EXPECT_LT((with.a - without.a).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_TRUE(std::isnan(with.residuals(3, 3)));
}

TEST(ShiftSeparation, ReturnsTwoCurvesOfThousandsOfStopsWithGaps) {
  const int n = 3600;
  const std::vector<int> shifts = {0, 1, 61, 411, 1203};
  const MatrixXd truth = NormalValues(n, 2);
  const MatrixXd weight = WeightsOf({"many", n, shifts, Free::kConstant, 0.02, 1.0});
  MatrixXd values = ReadingsOf(truth, shifts);
  for (int j = 0; j < 5; ++j)
    values.col(j) = (weight.col(j).array() == 0.0).select(kNaN, values.col(j).array() + 10.0 * j);
  const ShiftSeparation separation(shifts, Free::kConstant, weight);
  const ShiftSolution found = separation.Solve(values);
  EXPECT_TRUE(found.convergence.converged);
  EXPECT_LT(found.convergence.iterations, 150);
  const VectorXd a = truth.col(0).array() - truth.col(0).mean(), b = truth.col(1).array() - truth.col(1).mean();
  EXPECT_LT((found.a - a).cwiseAbs().maxCoeff(), 1e-11);  // 1e-16 times readings of 40 and a noise gain near 1
  EXPECT_LT((found.b - b).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(ShiftSeparation, SolvesTwoSetUpsOfManyStopsToTheLastDigitsThatThereAre) {
  // The first harmonic has 1 / sin(pi / n) = 5700 times the noise of the best: 1e-16 times that, summed over
  // harmonics.
  const int n = 18000;
  const MatrixXd truth = NormalValues(n, 2);
  const ShiftSeparation separation({0, 1}, Free::kConstant, MatrixXd::Ones(n, 2));
  const ShiftSolution found = separation.Solve(ReadingsOf(truth, {0, 1}));
  EXPECT_TRUE(found.convergence.converged);
  EXPECT_LT((found.b.array() - truth.col(1).array() + truth.col(1).mean()).abs().maxCoeff(), 1e-11);
}

TEST(ShiftSeparation, SaysSoWhereItHasNotConverged) {
  const Problem p{"few_steps", 60, {0, 1, 7}, Free::kConstant, 0.1, 4.0};
  const ShiftSeparation few(p.shifts, p.free, WeightsOf(p), 2), enough(p.shifts, p.free, WeightsOf(p));
  const MatrixXd values = NormalValues(60, 3);
  EXPECT_FALSE(few.search_converged());
  EXPECT_FALSE(few.Solve(values).convergence.converged);
  EXPECT_GT(few.Solve(values).convergence.relative_error, 1e-12);
  EXPECT_TRUE(enough.Solve(values).convergence.converged);
}

TEST(ShiftSeparation, CallsNothingDeterminedThatDoublesCannotTell) {
  const Problem p{"wild_weights", 60, {0, 1, 7}, Free::kConstant, 0.0, 40.0};
  const ShiftSeparation separation(p.shifts, p.free, WeightsOf(p));
  const MatrixXd truth = NormalValues(60, 2);
  const ShiftSolution found = separation.Solve(ReadingsOf(truth, p.shifts));
  double shown = 0.0, meant = 0.0;
  int count = 0;
  for (int i = 0; i < 60; ++i) {
    if (!separation.IsDetermined(Curve::kA, i)) continue;
    meant += truth(i, 0);
    ++count;
  }
  EXPECT_LT(count, 60);
  for (int i = 0; i < 60; ++i) {
    if (!separation.IsDetermined(Curve::kA, i)) continue;
    shown = std::max(shown, std::abs(found.a[i] - (truth(i, 0) - meant / count)));
  }
  EXPECT_LT(shown, 1e-4);  // 1e-6 a value, and the mean of sixty
}

TEST(ShiftSeparation, RefusesWhatIsNoProblem) {
  EXPECT_THROW(ShiftSeparation({0, 1}, Free::kConstant, MatrixXd::Ones(12, 3)), std::logic_error);
  EXPECT_THROW(ShiftSeparation({0, 1}, Free::kConstant, MatrixXd::Zero(12, 2)), std::logic_error);
  EXPECT_THROW(ShiftSeparation({0, 1}, Free::kConstant, -MatrixXd::Ones(12, 2)), std::logic_error);
  const ShiftSeparation separation({0, 1}, Free::kConstant, MatrixXd::Ones(12, 2));
  EXPECT_THROW(separation.Solve(MatrixXd::Zero(11, 2)), std::logic_error);
}

}  // namespace
}  // namespace twinbench::separate::shifts
