#include "twin/separate/shift_separation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/stream.h"

namespace twinbench::separate::shifts {
namespace {

constexpr double kStepTolerance = 1e-15;  // of the gradients' first norm: where a round of steps ends
constexpr double kConverged = 1e-12;      // of the true gradient: what a round must have reached
constexpr int kRounds = 4;
constexpr double kCameBack = 1e-6;  // of unknowns of size one
constexpr int kProbes = 8;
constexpr double kSameProbe = 1e-6;  // of the largest: linear dependence of what did not come back

/// Columns of `all`.
Eigen::MatrixXd Chosen(const Eigen::MatrixXd& all, const std::vector<Eigen::Index>& columns) {
  return all(Eigen::all, columns);
}

/// Set-ups that have more readings than free terms.
std::vector<Eigen::Index> SetUpsRead(const Eigen::MatrixXd& weight, Eigen::Index terms) {
  std::vector<Eigen::Index> read;
  for (Eigen::Index j = 0; j < weight.cols(); ++j) {
    if ((weight.col(j).array() > 0.0).count() > terms) read.push_back(j);
  }
  Require(!read.empty(), "at least one mounting has more readings than free terms");
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

/// Odd in its values: the mean of the middle two where their number is even.
double MedianOf(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

/// Most values of a class have come back with the same constant, which those that have not must not move.
void RemoveClassMediansOfRow(int classes, const std::vector<bool>& used, Eigen::Ref<Eigen::VectorXd> values) {
  const Eigen::Index n = values.size();
  for (Eigen::Index r = 0; r < classes; ++r) {
    std::vector<double> of_class;
    for (Eigen::Index i = r; i < n; i += classes) {
      if (used[static_cast<std::size_t>(i)]) of_class.push_back(values[i]);
    }
    if (of_class.empty()) continue;
    const double median = MedianOf(of_class);
    for (Eigen::Index i = r; i < n; i += classes) {
      values[i] = used[static_cast<std::size_t>(i)] ? values[i] - median : 0.0;
    }
  }
}

/// Calls remove(used, values) for each n values of rows that stand one behind the other.
template <typename Remove>
void ForEachRow(Eigen::Index n, const std::vector<bool>& used, Eigen::Ref<Eigen::VectorXd> values,
                const Remove& remove) {
  for (Eigen::Index first = 0; first < values.size(); first += n)
    remove(std::vector<bool>(used.begin() + first, used.begin() + first + n), values.segment(first, n));
}

void RemoveMeans(int classes, Eigen::Index n, const std::vector<bool>& used, Eigen::Ref<Eigen::VectorXd> values) {
  ForEachRow(n, used, values, [&](const std::vector<bool>& of_row, Eigen::Ref<Eigen::VectorXd> row) {
    RemoveClassMeans(classes, of_row, row);
  });
}

void RemoveMedians(int classes, Eigen::Index n, const std::vector<bool>& used, Eigen::Ref<Eigen::VectorXd> values) {
  ForEachRow(n, used, values, [&](const std::vector<bool>& of_row, Eigen::Ref<Eigen::VectorXd> row) {
    RemoveClassMediansOfRow(classes, of_row, row);
  });
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

/// One curve's part of what has not come back.
struct NotBack {
  std::vector<bool> far;  // values that no constant of their class explains
  Eigen::VectorXd open;   // the same without class means, which keeps sums what they are
};

NotBack WhatIsNotBack(int classes, Eigen::Index n, const std::vector<bool>& seen, const Eigen::MatrixXd& lost,
                      const Eigen::VectorXd& difference) {
  const Eigen::MatrixXd known = Restricted(classes, n, seen, lost);
  Eigen::VectorXd about_median = difference, about_mean = difference;
  RemoveMedians(classes, n, seen, about_median);
  RemoveMeans(classes, n, seen, about_mean);
  about_median -= known * (known.transpose() * about_median);
  about_mean -= known * (known.transpose() * about_mean);
  NotBack result{std::vector<bool>(seen.size()), about_mean};
  for (std::size_t i = 0; i < seen.size(); ++i) {
    result.far[i] = std::abs(about_median[static_cast<Eigen::Index>(i)]) > kCameBack;
  }
  return result;
}

void Strike(const std::vector<bool>& far, std::vector<bool>& determined) {
  for (std::size_t i = 0; i < far.size(); ++i) determined[i] = determined[i] && !far[i];
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

ShiftSeparation::ShiftSeparation(std::vector<int> shifts, Free free, Eigen::MatrixXd weight, int most_steps,
                                 std::vector<int> rows)
    : n_(weight.rows()),
      shifts_(std::move(shifts)),
      rows_(std::move(rows)),
      most_steps_(most_steps),
      weight_(CheckedWeights(shifts_, std::move(weight))),
      terms_(TermsAtStops(static_cast<int>(n_), free)),
      read_(SetUpsRead(weight_, terms_.cols())),
      inverse_(MeanWeights(shifts_, rows_, weight_, read_), free),
      determined_a_(static_cast<std::size_t>(n_), false),
      determined_b_(static_cast<std::size_t>(CurveValues() - n_), false) {
  Require(rows_.empty() || rows_.size() == shifts_.size(), "one row a mounting");
  for (const Eigen::Index j : read_) {
    even_ = even_ && weight_.col(j).minCoeff() == weight_.col(j).maxCoeff();
    for (Eigen::Index i = 0; i < n_; ++i) {
      if (weight_(i, j) == 0.0) continue;
      determined_a_[static_cast<std::size_t>(i)] = true;
      const Eigen::Index place = Place(i, shifts_[static_cast<std::size_t>(j)], n_);
      const Eigen::Index row = rows_.empty() ? 0 : rows_[static_cast<std::size_t>(j)];
      determined_b_[static_cast<std::size_t>(row * n_ + place)] = true;
    }
  }
  FindUndetermined();
  const int classes = CommonDivisor(inverse_.set());
  lost_of_a_ = Restricted(classes, n_, determined_a_, inverse_.lost_of_a());
  lost_of_b_ = Restricted(classes, n_, determined_b_, inverse_.lost_of_b());
}

/// Row of one of the set-ups that were read.
Eigen::Index ShiftSeparation::RowAt(Eigen::Index column) const {
  return inverse_.set().rows.empty() ? 0 : inverse_.set().rows[static_cast<std::size_t>(column)];
}

/// Readings of the set-ups that were read, one column each.
Eigen::MatrixXd ShiftSeparation::Predict(const Eigen::VectorXd& x) const {
  Eigen::MatrixXd readings(n_, std::ssize(read_));
  const Eigen::Index count = terms_.cols();
  for (Eigen::Index c = 0; c < readings.cols(); ++c) {
    const Eigen::Index by = Place(0, inverse_.set().shifts[static_cast<std::size_t>(c)], n_);
    const Eigen::Index b = (1 + RowAt(c)) * n_;
    auto column = readings.col(c);
    column = x.head(n_);
    column.head(n_ - by) += x.segment(b + by, n_ - by);
    column.tail(by) += x.segment(b, by);
    if (count > 0) column += terms_ * x.segment(CurveValues() + c * count, count);
  }
  return readings;
}

/// Transpose of Predict.
Eigen::VectorXd ShiftSeparation::Gather(const Eigen::MatrixXd& weighted) const {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(inverse_.unknowns());
  const Eigen::Index count = terms_.cols();
  for (Eigen::Index c = 0; c < weighted.cols(); ++c) {
    const Eigen::Index by = Place(0, inverse_.set().shifts[static_cast<std::size_t>(c)], n_);
    const Eigen::Index b = (1 + RowAt(c)) * n_;
    const auto column = weighted.col(c);
    sums.head(n_) += column;
    sums.segment(b + by, n_ - by) += column.head(n_ - by);
    sums.segment(b, by) += column.tail(by);
    if (count > 0) sums.segment(CurveValues() + c * count, count) = terms_.transpose() * column;
  }
  return sums;
}

/// Unknowns of the set-ups that were read, from their readings. Rounds start from the true residuals again, as the
/// recurrence's own drift away from them.
Eigen::VectorXd ShiftSeparation::Minimise(const Eigen::MatrixXd& values, Convergence& convergence) const {
  const Eigen::MatrixXd weight = Chosen(weight_, read_);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(inverse_.unknowns());
  double first = 0.0;
  for (int round = 0; round <= kRounds; ++round) {
    Eigen::MatrixXd left = values - Predict(x);
    Eigen::VectorXd gradient = Gather(weight.cwiseProduct(left));
    Eigen::VectorXd step = inverse_.Apply(gradient);
    double size = gradient.dot(step);
    if (round == 0) first = size;
    convergence.relative_error = first > 0.0 ? std::sqrt(std::max(size, 0.0) / first) : 0.0;
    convergence.converged = convergence.relative_error < kConverged;
    if (!(size > 0.0) || (convergence.converged && round > 1) || round == kRounds) break;
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
      if (!(next > kStepTolerance * kStepTolerance * first)) break;
      direction = step + next / size * direction;
      size = next;
    }
  }
  return x;
}

/// Means of the classes, lost directions and undetermined values off both curves.
Eigen::VectorXd ShiftSeparation::Estimable(const Eigen::VectorXd& curves) const {
  const int classes = CommonDivisor(inverse_.set());
  Eigen::VectorXd left = curves;
  const Eigen::Index of_b = curves.size() - n_;
  RemoveMeans(classes, n_, determined_a_, left.head(n_));
  RemoveMeans(classes, n_, determined_b_, left.tail(of_b));
  left.head(n_) -= lost_of_a_ * (lost_of_a_.transpose() * left.head(n_));
  left.tail(of_b) -= lost_of_b_ * (lost_of_b_.transpose() * left.tail(of_b));
  return left;
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
void ShiftSeparation::FindUndetermined() {
  const int classes = CommonDivisor(inverse_.set());
  const std::vector<bool> seen_a = determined_a_, seen_b = determined_b_;
  const Eigen::MatrixXd weight = Chosen(weight_, read_);
  Eigen::MatrixXd open(CurveValues(), 0);
  Eigen::Index lost = 0;
  for (int probe = 0; !even_ && probe < kProbes && lost == open.cols(); ++probe) {
    const Eigen::VectorXd drawn = Normals(inverse_.unknowns(), probe);
    Convergence convergence;
    const Eigen::VectorXd difference = Minimise(Predict(drawn), convergence) - drawn;
    search_converged_ = search_converged_ && convergence.converged;
    const NotBack a = WhatIsNotBack(classes, n_, seen_a, inverse_.lost_of_a(), difference.head(n_));
    const NotBack b = WhatIsNotBack(classes, n_, seen_b, inverse_.lost_of_b(), difference.segment(n_, CurveValues() - n_));
    Strike(a.far, determined_a_);
    Strike(b.far, determined_b_);
    open.conservativeResize(Eigen::NoChange, open.cols() + 1);
    open.rightCols(1) << a.open, b.open;
    lost = RankOf(open);
  }
  if (lost == kProbes) return;
  const auto seen = std::count(seen_a.begin(), seen_a.end(), true) + std::count(seen_b.begin(), seen_b.end(), true);
  const Eigen::Index unknowns = seen + terms_.cols() * std::ssize(read_);
  const int null = inverse_.null_directions() - classes + NonEmptyClasses(classes, seen_a);
  dof_ = static_cast<double>((weight.array() > 0.0).count() - (unknowns - null - lost));
}

ShiftSolution ShiftSeparation::Solve(const Eigen::MatrixXd& values) const {
  Require(values.rows() == n_ && values.cols() == weight_.cols(), "one value a stop and mounting");
  const Eigen::MatrixXd weight = Chosen(weight_, read_);
  const Eigen::MatrixXd chosen = (weight.array() > 0.0).select(Chosen(values, read_), 0.0);
  ShiftSolution solution;
  const Eigen::VectorXd x = Minimise(chosen, solution.convergence);
  Eigen::VectorXd curves = Estimable(x.head(CurveValues()));
  MarkUndetermined(curves);
  solution.unknowns = x;
  solution.a = curves.head(n_);
  solution.b = curves.tail(CurveValues() - n_);
  const Eigen::MatrixXd left = chosen - Predict(x);
  solution.chi2 = left.cwiseAbs2().cwiseProduct(weight).sum();
  solution.residuals = Eigen::MatrixXd::Constant(n_, weight_.cols(), kNaN);
  solution.free = Eigen::MatrixXd::Constant(terms_.cols(), weight_.cols(), kNaN);
  for (Eigen::Index c = 0; c < std::ssize(read_); ++c) {
    const Eigen::Index j = read_[static_cast<std::size_t>(c)];
    solution.residuals.col(j) = (weight.col(c).array() > 0.0).select(left.col(c), kNaN);
    solution.free.col(j) = x.segment(CurveValues() + c * terms_.cols(), terms_.cols());
  }
  return solution;
}

/// NaN where nothing is determined.
void ShiftSeparation::MarkUndetermined(Eigen::VectorXd& curves) const {
  for (Eigen::Index i = 0; i < curves.size(); ++i) {
    if (!IsDetermined(i < n_ ? Curve::kA : Curve::kB, static_cast<int>(i < n_ ? i : i - n_))) curves[i] = kNaN;
  }
}

Eigen::VectorXd ShiftSeparation::CovarianceWith(Curve curve, int stop) const {
  Require(stop >= 0 && stop < (curve == Curve::kA ? n_ : CurveValues() - n_), "a stop is one of n");
  if (!IsDetermined(curve, stop)) return Eigen::VectorXd::Constant(CurveValues(), kNaN);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(inverse_.unknowns());
  right[curve == Curve::kA ? stop : n_ + stop] = 1.0;
  right.head(CurveValues()) = Estimable(right.head(CurveValues()));
  Eigen::VectorXd column = Estimable(SolveNormalEquations(right).head(CurveValues()));
  MarkUndetermined(column);
  return column;
}

LagCovariance ShiftSeparation::Lags() const {
  Require(even_ && lost_of_a_.cols() == 0 && lost_of_b_.cols() == 0 && terms_.cols() < 2 && inverse_.curves() == 2,
          "lags alone decide for complete, evenly weighted circles of one row without ramps");
  const Eigen::VectorXd with_first = CovarianceWith(Curve::kA, 0);
  return {with_first.head(n_), with_first.tail(n_)};
}

bool ShiftSeparation::IsDetermined(Curve curve, int stop) const {
  return (curve == Curve::kA ? determined_a_ : determined_b_).at(static_cast<std::size_t>(stop));
}

Eigen::Index ShiftSeparation::LostDirections(Curve curve) const {
  return (curve == Curve::kA ? lost_of_a_ : lost_of_b_).cols();
}

}  // namespace twinbench::separate::shifts
