#include "twin/separate/even_inverse.h"

#include <algorithm>
#include <complex>
#include <utility>

#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"

namespace twinbench::separate::shifts {
namespace {

constexpr double kNoWeightLeft = 1e-10;  // of the largest weight: direction of the free unknowns that is lost
constexpr double kRounding = 4e-15;      // of a curve's harmonic, times its variance factor
constexpr double kSameDirection = 1e-6;  // of a unit column

using Complex = std::complex<double>;

/// One harmonic of both curves from its right-hand sides.
std::pair<Complex, Complex> SolveHarmonic(const HarmonicTransfer& t, Complex right_a, Complex right_b) {
  const double W = t.total;
  if (!t.lost) {
    return {(W * right_a - t.sum * right_b) / t.determinant,
            (W * right_b - std::conj(t.sum) * right_a) / t.determinant};
  }
  const Complex a = (W * right_a + t.sum * right_b) / (4.0 * W * W);
  return {a, std::conj(t.sum) / W * a};
}

/// Part of the largest weight that rounding may leave where there should be none.
double NoWeight(const std::vector<HarmonicTransfer>& transfers) {
  double worst = 1.0;
  for (const HarmonicTransfer& t : transfers) {
    if (!t.lost) worst = std::max(worst, t.VarianceFactor());
  }
  return std::max(kNoWeightLeft, kRounding * worst);
}

/// values[(i + shift) mod n] at i.
Eigen::VectorXd Turned(const Eigen::VectorXd& values, int shift) {
  const Eigen::Index n = values.size(), by = ((shift % n) + n) % n;
  Eigen::VectorXd turned(n);
  turned << values.tail(n - by), values.head(by);
  return turned;
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

int TermsOf(Free free) {
  return static_cast<int>(free);
}

Eigen::MatrixXd TermsAtStops(int n, Free free) {
  Eigen::MatrixXd terms(n, TermsOf(free));
  if (free != Free::kNothing) terms.col(0).setOnes();
  if (free == Free::kAffine) terms.col(1) = Eigen::VectorXd::LinSpaced(n, -1.0, 1.0);
  return terms;
}

EvenInverse::EvenInverse(ShiftSet set, Free free)
    : set_(std::move(set)), fourier_(set_.n), transfers_(Transfers(set_)) {
  EliminateFree(TermsAtStops(set_.n, free));
}

/// Both curves are real and go through one transform as a + j b.
Eigen::VectorXd EvenInverse::InvertCurves(const Eigen::VectorXd& right) const {
  const int n = set_.n;
  Eigen::VectorXcd both(n);
  both.real() = right.head(n);
  both.imag() = right.segment(n, n);
  Eigen::VectorXcd Z = fourier_.Forward(both);
  for (const HarmonicTransfer& t : transfers_) {
    const int k = t.order, mirror = (n - k) % n;
    const Complex right_a = 0.5 * (Z[k] + std::conj(Z[mirror]));
    const Complex right_b = Complex(0.0, -0.5) * (Z[k] - std::conj(Z[mirror]));
    const auto [a, b] = SolveHarmonic(t, right_a, right_b);
    Z[k] = a + Complex(0.0, 1.0) * b;
    Z[mirror] = std::conj(a) + Complex(0.0, 1.0) * std::conj(b);
  }
  both = fourier_.Backward(Z) / n;
  Eigen::VectorXd curves(2 * n);
  curves << both.real(), both.imag();
  return curves;
}

void EvenInverse::EliminateFree(const Eigen::MatrixXd& terms) {
  const Eigen::Index n = set_.n, count = terms.cols(), setups = std::ssize(set_.shifts);
  free_columns_.resize(2 * n, count * setups);
  eliminated_.resize(2 * n, count * setups);
  Eigen::MatrixXd own = Eigen::MatrixXd::Zero(count * setups, count * setups);
  for (Eigen::Index j = 0; j < setups; ++j) {
    const double weight = set_.weights[static_cast<std::size_t>(j)];
    own.block(j * count, j * count, count, count) = weight * terms.transpose() * terms;
    for (Eigen::Index q = 0; q < count; ++q) {
      auto column = free_columns_.col(j * count + q);
      column << weight * terms.col(q), weight * Turned(terms.col(q), -set_.shifts[static_cast<std::size_t>(j)]);
      eliminated_.col(j * count + q) = InvertCurves(column);
    }
  }
  Eigen::MatrixXd null(2 * n, 0);
  free_inverse_.resize(own.rows(), own.cols());
  if (own.rows() > 0) {
    const auto [values, vectors] = EigenOfSymmetric(own - free_columns_.transpose() * eliminated_);
    const Eigen::Index none = (values.array() <= NoWeight(transfers_) * own.diagonal().maxCoeff()).count();
    const auto kept = vectors.rightCols(values.size() - none);
    free_inverse_ = kept * values.tail(values.size() - none).cwiseInverse().asDiagonal() * kept.transpose();
    null = eliminated_ * vectors.leftCols(none);
  }
  FindLostCurves(null);
}

void EvenInverse::FindLostCurves(const Eigen::MatrixXd& null) {
  const int classes = CommonDivisor(set_);
  null_directions_ = classes + static_cast<int>(null.cols());
  lost_of_a_ = Directions(WithoutClassMeans(classes, null.topRows(set_.n)));
  lost_of_b_ = Directions(WithoutClassMeans(classes, null.bottomRows(set_.n)));
}

Eigen::VectorXd EvenInverse::Apply(const Eigen::VectorXd& right) const {
  Require(right.size() == unknowns(), "one value an unknown");
  const int curves = 2 * set_.n;
  Eigen::VectorXd x(right.size());
  x.tail(right.size() - curves) =
      free_inverse_ * (right.tail(right.size() - curves) - eliminated_.transpose() * right.head(curves));
  x.head(curves) = InvertCurves(right.head(curves)) - eliminated_ * x.tail(right.size() - curves);
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
