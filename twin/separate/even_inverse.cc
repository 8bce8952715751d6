#include "twin/separate/even_inverse.h"

#include <algorithm>
#include <utility>

#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"

namespace twinbench::separate::shifts {
namespace {

constexpr double kNoWeightLeft = 1e-10;  // of the largest weight: direction of the constants that is lost
constexpr double kRounding = 4e-15;      // of a curve's harmonic, times its variance factor
constexpr double kSameDirection = 1e-6;  // of a unit column

using Complex = std::complex<double>;

/// Weight of a in each harmonic, b eliminated; 0 where every row has lost it.
std::vector<double> WeightsOfA(const std::vector<std::vector<HarmonicTransfer>>& rows) {
  std::vector<double> weights(rows.front().size(), 0.0);
  for (const std::vector<HarmonicTransfer>& row : rows) {
    for (std::size_t k = 0; k < row.size(); ++k) weights[k] += row[k].lost ? 0.0 : row[k].determinant / row[k].total;
  }
  return weights;
}

/// Part of the largest weight that rounding may leave where there should be none.
double NoWeight(const std::vector<std::vector<HarmonicTransfer>>& rows, const std::vector<double>& weight_of_a) {
  double total = 0.0, worst = 1.0;
  for (const std::vector<HarmonicTransfer>& row : rows) total += row.front().total;
  for (const double weight : weight_of_a) {
    if (weight > 0.0) worst = std::max(worst, total / weight);
  }
  return std::max(kNoWeightLeft, kRounding * worst);
}

Eigen::MatrixXd WithoutClassMeans(int classes, const Eigen::MatrixXd& columns) {
  const std::vector<bool> all(static_cast<std::size_t>(columns.rows()), true);
  Eigen::MatrixXd left = columns;
  for (Eigen::Index c = 0; c < left.cols(); ++c) RemoveClassMeans(classes, all, left.col(c));
  return left;
}

/// Orthonormal columns for what is left of unit-sized directions.
Eigen::MatrixXd Directions(const Eigen::MatrixXd& columns) {
  std::vector<Eigen::Index> there;
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    if (columns.col(c).norm() > kSameDirection) there.push_back(c);
  }
  if (there.empty()) return Eigen::MatrixXd::Zero(columns.rows(), 0);
  return OrthonormalBasisOf(columns(Eigen::all, there), kSameDirection);
}

}  // namespace

EvenInverse::EvenInverse(ShiftSet set) : set_(std::move(set)), fourier_(set_.n) {
  for (int row = 0; row < set_.Rows(); ++row) rows_.push_back(Transfers(set_.OfRow(row)));
  weight_of_a_ = WeightsOfA(rows_);
  EliminateConstants();
}

/// Two real curves go through one transform as x + j y.
Eigen::VectorXd EvenInverse::InvertCurves(const Eigen::VectorXd& right) const {
  const int n = set_.n, count = curves();
  std::vector<Eigen::VectorXcd> pairs;
  for (int c = 0; c < count; c += 2) {
    Eigen::VectorXcd both = right.segment(c * n, n).cast<Complex>();
    if (c + 1 < count) both.imag() = right.segment((c + 1) * n, n);
    pairs.push_back(fourier_.Forward(both));
  }
  std::vector<Complex> wave(static_cast<std::size_t>(count));
  for (int k = 0; 2 * k <= n; ++k) {
    const int mirror = (n - k) % n;
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      const Complex z = pairs[p][k], z_mirror = std::conj(pairs[p][mirror]);
      wave[2 * p] = 0.5 * (z + z_mirror);
      if (2 * p + 1 < wave.size()) wave[2 * p + 1] = Complex(0.0, -0.5) * (z - z_mirror);
    }
    SolveHarmonic(k, wave);
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      const Complex x = wave[2 * p], y = 2 * p + 1 < wave.size() ? wave[2 * p + 1] : Complex();
      pairs[p][k] = x + Complex(0.0, 1.0) * y;
      pairs[p][mirror] = std::conj(x) + Complex(0.0, 1.0) * std::conj(y);
    }
  }
  Eigen::VectorXd solved(count * n);
  for (int c = 0; c < count; c += 2) {
    const Eigen::VectorXcd both = fourier_.Backward(pairs[static_cast<std::size_t>(c / 2)]) / n;
    solved.segment(c * n, n) = both.real();
    if (c + 1 < count) solved.segment((c + 1) * n, n) = both.imag();
  }
  return solved;
}

/// Of a and the rows' b, from right-hand sides to solutions.
void EvenInverse::SolveHarmonic(int order, std::vector<Complex>& wave) const {
  const auto k = static_cast<std::size_t>(order);
  Complex a = wave[0];
  for (std::size_t r = 0; r < rows_.size(); ++r) a -= rows_[r][k].sum / rows_[r][k].total * wave[r + 1];
  a = weight_of_a_[k] > 0.0 ? a / weight_of_a_[k] : Complex();
  for (std::size_t r = 0; r < rows_.size(); ++r)
    wave[r + 1] = (wave[r + 1] - std::conj(rows_[r][k].sum) * a) / rows_[r][k].total;
  wave[0] = a;
}

void EvenInverse::EliminateConstants() {
  const Eigen::Index n = set_.n, setups = std::ssize(set_.shifts);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(curves() * n, setups), own = Eigen::MatrixXd::Zero(setups, setups);
  eliminated_.resize(curves() * n, setups);
  for (Eigen::Index j = 0; j < setups; ++j) {
    const double weight = set_.weights[static_cast<std::size_t>(j)];
    const Eigen::Index row = set_.rows.empty() ? 0 : set_.rows[static_cast<std::size_t>(j)];
    own(j, j) = weight * static_cast<double>(n);
    columns.col(j).head(n).setConstant(weight);
    columns.col(j).segment((1 + row) * n, n).setConstant(weight);
    eliminated_.col(j) = InvertCurves(columns.col(j));
  }
  const auto [values, vectors] = EigenOfSymmetric(own - columns.transpose() * eliminated_);
  const Eigen::Index none = (values.array() <= NoWeight(rows_, weight_of_a_) * own.diagonal().maxCoeff()).count();
  const auto kept = vectors.rightCols(values.size() - none);
  constant_inverse_ = kept * values.tail(values.size() - none).cwiseInverse().asDiagonal() * kept.transpose();
  FindLostCurves(eliminated_ * vectors.leftCols(none));
}

void EvenInverse::FindLostCurves(const Eigen::MatrixXd& null) {
  const int classes = CommonDivisor(set_);
  null_directions_ = classes + static_cast<int>(null.cols());
  lost_of_a_ = Directions(WithoutClassMeans(classes, null.topRows(set_.n)));
  Eigen::MatrixXd null_of_b = null.bottomRows(null.rows() - set_.n);
  for (Eigen::Index row = 0; row < null_of_b.rows(); row += set_.n)
    null_of_b.middleRows(row, set_.n) = WithoutClassMeans(classes, null_of_b.middleRows(row, set_.n));
  lost_of_b_ = Directions(null_of_b);
}

Eigen::VectorXd EvenInverse::Apply(const Eigen::VectorXd& right) const {
  Require(right.size() == unknowns(), "one value an unknown");
  const int values = curves() * set_.n;
  Eigen::VectorXd x(right.size());
  x.tail(right.size() - values) =
      constant_inverse_ * (right.tail(right.size() - values) - eliminated_.transpose() * right.head(values));
  x.head(values) = InvertCurves(right.head(values)) - eliminated_ * x.tail(right.size() - values);
  return x;
}

void RemoveClassMeans(int classes, const std::vector<bool>& used, Eigen::Ref<Eigen::VectorXd> values) {
  const Eigen::Index n = values.size();
  for (Eigen::Index r = 0; r < classes; ++r) {
    double sum = 0.0;
    int count = 0;
    for (Eigen::Index i = r; i < n; i += classes) {
      if (!used[static_cast<std::size_t>(i)]) continue;
      sum += values[i];
      ++count;
    }
    for (Eigen::Index i = r; i < n; i += classes) {
      values[i] = used[static_cast<std::size_t>(i)] ? values[i] - sum / count : 0.0;
    }
  }
}

}  // namespace twinbench::separate::shifts
