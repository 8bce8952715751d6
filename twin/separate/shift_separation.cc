#include "twin/separate/shift_separation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/stream.h"

namespace twinbench::separate::shifts {
namespace {

// Of the readings' norm, as the rounding errors of all gradients are: a step along these finds no end.
constexpr double kStepTolerance = 1e-15;  // where a round of steps ends
constexpr double kConverged = 1e-12;      // of the true gradient: what a round must have reached
constexpr int kRounds = 4;
constexpr double kCameBack = 1e-6;  // of unknowns of size one
constexpr int kProbes = 8;
constexpr double kSameProbe = 1e-6;  // of the largest: linear dependence of what did not come back

/// Columns of `all`.
Eigen::MatrixXd Chosen(const Eigen::MatrixXd& all, const std::vector<Eigen::Index>& columns) {
  return all(Eigen::all, columns);
}

/// Set-ups that have more readings than their constant.
std::vector<Eigen::Index> SetUpsRead(const Eigen::MatrixXd& weight) {
  std::vector<Eigen::Index> read;
  for (Eigen::Index j = 0; j < weight.cols(); ++j) {
    if ((weight.col(j).array() > 0.0).count() > 1) read.push_back(j);
  }
  Require(!read.empty(), "at least one mounting has more than one reading");
  return read;
}

ShiftSet MeanWeights(const std::vector<int>& shifts, const std::vector<int>& rows, const Eigen::MatrixXd& weight,
                     const std::vector<Eigen::Index>& read) {
  ShiftSet set{static_cast<int>(weight.rows()), {}, {}};
  for (const Eigen::Index j : read) {
    set.shifts.push_back(shifts[static_cast<std::size_t>(j)]);
    set.weights.push_back(weight.col(j).mean());
    if (!rows.empty()) set.rows.push_back(rows[static_cast<std::size_t>(j)]);
  }
  return set;
}

Eigen::MatrixXd CheckedWeights(const std::vector<int>& shifts, Eigen::MatrixXd weight) {
  Require(weight.rows() > 0 && weight.cols() == std::ssize(shifts), "one column of weights a mounting");
  Require(weight.allFinite() && weight.minCoeff() >= 0.0, "weights are finite, 0 where nothing was read");
  return weight;
}

Eigen::Index Place(Eigen::Index i, int shift, Eigen::Index n) {
  return ((i + shift) % n + n) % n;
}

/// Of each n values of rows that stand one behind the other.
void RemoveMeans(int classes, Eigen::Index n, const std::vector<bool>& used, Eigen::Ref<Eigen::VectorXd> values) {
  for (Eigen::Index first = 0; first < values.size(); first += n)
    RemoveClassMeans(classes, {used.begin() + first, used.begin() + first + n}, values.segment(first, n));
}

/// Lost directions over the values that are used only.
Eigen::MatrixXd Restricted(int classes, Eigen::Index n, const std::vector<bool>& used,
                           const Eigen::MatrixXd& directions) {
  Eigen::MatrixXd left = directions;
  for (Eigen::Index c = 0; c < left.cols(); ++c) RemoveMeans(classes, n, used, left.col(c));
  if (left.cols() == 0 || left.norm() < kCameBack) return Eigen::MatrixXd::Zero(left.rows(), 0);
  return OrthonormalBasisOf(left, kCameBack);
}

int NonEmptyClasses(int classes, const std::vector<bool>& used) {
  std::vector<bool> any(static_cast<std::size_t>(classes), false);
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i]) any[i % any.size()] = true;
  }
  return static_cast<int>(std::count(any.begin(), any.end(), true));
}

/// One curve's part of what has not come back, without class means, which keeps sums what they are.
Eigen::VectorXd NotBack(int classes, Eigen::Index n, const std::vector<bool>& seen, const Eigen::MatrixXd& lost,
                        Eigen::VectorXd difference) {
  const Eigen::MatrixXd known = Restricted(classes, n, seen, lost);
  RemoveMeans(classes, n, seen, difference);
  return difference - known * (known.transpose() * difference);
}

Eigen::Index RankOf(const Eigen::MatrixXd& columns) {
  return columns.cwiseAbs().maxCoeff() > kCameBack ? OrthonormalBasisOf(columns, kSameProbe).cols() : 0;
}

Eigen::VectorXd Normals(Eigen::Index count, int probe) {
  Stream random(static_cast<std::uint64_t>(probe) + 1, "separate.shift_probe");
  Eigen::VectorXd values(count);
  for (double& v : values) v = random.Normal();
  return values;
}

}  // namespace

ShiftSeparation::ShiftSeparation(const std::vector<int>& shifts, Eigen::MatrixXd weight, int most_steps,
                                 const std::vector<int>& rows)
    : n_(weight.rows()),
      most_steps_(most_steps),
      weight_(CheckedWeights(shifts, std::move(weight))),
      read_(SetUpsRead(weight_)),
      inverse_(MeanWeights(shifts, rows, weight_, read_)) {
  Require(rows.empty() || rows.size() == shifts.size(), "one row a mounting");
  for (const Eigen::Index j : read_) even_ = even_ && weight_.col(j).minCoeff() == weight_.col(j).maxCoeff();
  CountDegreesOfFreedom();
}

/// Row of one of the set-ups that were read.
Eigen::Index ShiftSeparation::RowAt(Eigen::Index column) const {
  return inverse_.set().rows.empty() ? 0 : inverse_.set().rows[static_cast<std::size_t>(column)];
}

/// Readings of the set-ups that were read, one column each.
Eigen::MatrixXd ShiftSeparation::Predict(const Eigen::VectorXd& x) const {
  Eigen::MatrixXd readings(n_, std::ssize(read_));
  for (Eigen::Index c = 0; c < readings.cols(); ++c) {
    const Eigen::Index by = Place(0, inverse_.set().shifts[static_cast<std::size_t>(c)], n_);
    const Eigen::Index b = (1 + RowAt(c)) * n_;
    auto column = readings.col(c);
    column = x.head(n_);
    column.head(n_ - by) += x.segment(b + by, n_ - by);
    column.tail(by) += x.segment(b, by);
    column.array() += x[CurveValues() + c];
  }
  return readings;
}

/// Transpose of Predict.
Eigen::VectorXd ShiftSeparation::Gather(const Eigen::MatrixXd& weighted) const {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(inverse_.unknowns());
  for (Eigen::Index c = 0; c < weighted.cols(); ++c) {
    const Eigen::Index by = Place(0, inverse_.set().shifts[static_cast<std::size_t>(c)], n_);
    const Eigen::Index b = (1 + RowAt(c)) * n_;
    const auto column = weighted.col(c);
    sums.head(n_) += column;
    sums.segment(b + by, n_ - by) += column.head(n_ - by);
    sums.segment(b, by) += column.tail(by);
    sums[CurveValues() + c] = column.sum();
  }
  return sums;
}

/// Unknowns of the set-ups that were read, from their readings. Rounds start from the true residuals again, as the
/// recurrence's own drift away from them.
Eigen::VectorXd ShiftSeparation::Minimise(const Eigen::MatrixXd& values, Convergence& convergence) const {
  const Eigen::MatrixXd weight = Chosen(weight_, read_);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(inverse_.unknowns());
  const double readings = values.cwiseAbs2().cwiseProduct(weight).sum(), rounding = kStepTolerance * kStepTolerance * readings;
  for (int round = 0; round <= kRounds; ++round) {
    Eigen::MatrixXd left = values - Predict(x);
    Eigen::VectorXd gradient = Gather(weight.cwiseProduct(left));
    Eigen::VectorXd step = inverse_.Apply(gradient);
    double size = gradient.dot(step);
    convergence.relative_error = readings > 0.0 ? std::sqrt(std::max(size, 0.0) / readings) : 0.0;
    convergence.converged = convergence.relative_error < kConverged;
    if (!(size > rounding) || (convergence.converged && round > 1) || round == kRounds) break;
    Eigen::VectorXd direction = step;
    for (int k = 0; k < most_steps_; ++k) {
      const Eigen::MatrixXd along = Predict(direction);
      const double length = size / along.cwiseAbs2().cwiseProduct(weight).sum();
      if (!std::isfinite(length)) break;
      x += length * direction;
      left -= length * along;
      ++convergence.iterations;
      gradient = Gather(weight.cwiseProduct(left));
      step = inverse_.Apply(gradient);
      const double next = gradient.dot(step);
      if (!(next > rounding)) break;
      direction = step + next / size * direction;
      size = next;
    }
  }
  return x;
}

/// x of N x = right for a right-hand side in the range of the normal matrix N.
Eigen::VectorXd ShiftSeparation::SolveNormalEquations(const Eigen::VectorXd& right) const {
  const Eigen::MatrixXd weight = Chosen(weight_, read_);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(right.size()), gradient = right;
  Eigen::VectorXd step = inverse_.Apply(gradient), direction = step;
  double size = gradient.dot(step);
  const double last = kStepTolerance * kStepTolerance * size;
  for (int k = 0; k < most_steps_ && size > last; ++k) {
    const Eigen::VectorXd along = Gather(weight.cwiseProduct(Predict(direction)));
    const double length = size / direction.dot(along);
    x += length * direction;
    gradient -= length * along;
    step = inverse_.Apply(gradient);
    const double next = gradient.dot(step);
    direction = step + next / size * direction;
    size = next;
  }
  return x;
}

/// Probes until one more adds no direction to those that have not come back.
void ShiftSeparation::CountDegreesOfFreedom() {
  const int classes = CommonDivisor(inverse_.set());
  const Eigen::MatrixXd weight = Chosen(weight_, read_);
  const Eigen::VectorXd shown = Gather((weight.array() > 0.0).cast<double>());
  const auto seen = [&](Eigen::Index first, Eigen::Index count) {
    std::vector<bool> any;
    for (const double readings : shown.segment(first, count)) any.push_back(readings > 0.0);
    return any;
  };
  const std::vector<bool> seen_a = seen(0, n_), seen_b = seen(n_, CurveValues() - n_);
  Eigen::MatrixXd open(CurveValues(), 0);
  Eigen::Index lost = 0;
  for (int probe = 0; !even_ && probe < kProbes && lost == open.cols(); ++probe) {
    const Eigen::VectorXd drawn = Normals(inverse_.unknowns(), probe);
    Convergence convergence;
    const Eigen::VectorXd difference = Minimise(Predict(drawn), convergence) - drawn;
    open.conservativeResize(Eigen::NoChange, open.cols() + 1);
    open.rightCols(1) << NotBack(classes, n_, seen_a, inverse_.lost_of_a(), difference.head(n_)),
        NotBack(classes, n_, seen_b, inverse_.lost_of_b(), difference.segment(n_, CurveValues() - n_));
    lost = RankOf(open);
  }
  if (lost == kProbes) return;
  const Eigen::Index unknowns = (shown.array() > 0.0).count();  // curves that are seen, and constants
  const int null = inverse_.null_directions() - classes + NonEmptyClasses(classes, seen_a);
  dof_ = static_cast<double>((weight.array() > 0.0).count() - (unknowns - null - lost));
}

ShiftSolution ShiftSeparation::Solve(const Eigen::MatrixXd& values) const {
  Require(values.rows() == n_ && values.cols() == weight_.cols(), "one value a stop and mounting");
  const Eigen::MatrixXd weight = Chosen(weight_, read_);
  const Eigen::MatrixXd chosen = (weight.array() > 0.0).select(Chosen(values, read_), 0.0);
  ShiftSolution solution;
  solution.unknowns = Minimise(chosen, solution.convergence);
  const Eigen::MatrixXd left = chosen - Predict(solution.unknowns);
  solution.residuals = Eigen::MatrixXd::Constant(n_, weight_.cols(), kNaN);
  for (Eigen::Index c = 0; c < std::ssize(read_); ++c)
    solution.residuals.col(read_[static_cast<std::size_t>(c)]) = (weight.col(c).array() > 0.0).select(left.col(c), kNaN);
  return solution;
}

}  // namespace twinbench::separate::shifts
