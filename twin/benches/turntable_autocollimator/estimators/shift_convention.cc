#include "twin/benches/turntable_autocollimator/estimators/shift_convention.h"

#include <algorithm>
#include <utility>

namespace twinbench::separate::turntable {
namespace {

// With several rows and missing teeth means over classes and over rows disturb each other: what one leaves of the
// other shrinks by the share that is missing.
constexpr int kMostRounds = 30;

}  // namespace

ShiftConvention::ShiftConvention(const shifts::ShiftSet& set, std::vector<bool> read)
    : n_(set.n), classes_(shifts::CommonDivisor(set)), read_(std::move(read)) {
  for (int row = 0; row < set.Rows(); ++row) row_shift_.push_back(set.OfRow(row).shifts.front());
  rounds_ = set.Rows() == 1 || AllRead() ? 1 : kMostRounds;
  Eigen::VectorXd ones = Eigen::VectorXd::Ones(std::ssize(read_));
  teeth_ = ClassSums(ones, n_, ones.size());
}

bool ShiftConvention::AllRead() const {
  return std::ranges::all_of(read_, [](bool r) { return r; });
}

/// Remainder of the positions that meet it.
Eigen::Index ShiftConvention::ClassOf(Eigen::Index value) const {
  if (value < n_) return value % classes_;
  const int shift = row_shift_[static_cast<std::size_t>(value / n_ - 1)];
  return ((value % n_ - shift) % classes_ + classes_) % classes_;
}

/// Over the values from..to that were read.
std::vector<double> ShiftConvention::ClassSums(const Eigen::VectorXd& curves, Eigen::Index from,
                                               Eigen::Index to) const {
  std::vector<double> sums(static_cast<std::size_t>(classes_), 0.0);
  for (Eigen::Index i = from; i < to; ++i) {
    if (Read(i)) sums[static_cast<std::size_t>(ClassOf(i))] += curves[i];
  }
  return sums;
}

/// The mean of each class of b, over all rows, goes to a.
void ShiftConvention::MoveToA(Eigen::VectorXd& curves) const {
  const std::vector<double> sums = ClassSums(curves, n_, curves.size());
  for (Eigen::Index i = 0; i < curves.size(); ++i) {
    const auto c = static_cast<std::size_t>(ClassOf(i));
    if (teeth_[c] > 0.0) curves[i] += (i < n_ ? 1.0 : -1.0) * sums[c] / teeth_[c];
  }
}

void ShiftConvention::MoveToATransposed(Eigen::VectorXd& curves) const {
  const std::vector<double> of_b = ClassSums(curves, n_, curves.size());
  std::vector<double> of_a(of_b.size(), 0.0);
  for (Eigen::Index i = 0; i < n_; ++i) of_a[static_cast<std::size_t>(ClassOf(i))] += curves[i];
  for (Eigen::Index i = n_; i < curves.size(); ++i) {
    const auto c = static_cast<std::size_t>(ClassOf(i));
    if (!Read(i)) continue;
    curves[i] += (of_a[c] - of_b[c]) / teeth_[c];
  }
}

/// Of each curve from `from` on, over what was read; what was not read becomes zero.
void ShiftConvention::RemoveMeans(Eigen::VectorXd& curves, Eigen::Index from) const {
  for (Eigen::Index first = from; first < curves.size(); first += n_) {
    const std::vector<bool> used(read_.begin() + first, read_.begin() + first + n_);
    shifts::RemoveClassMeans(1, used, curves.segment(first, n_));
  }
}

Eigen::VectorXd ShiftConvention::Applied(const Eigen::VectorXd& curves) const {
  Eigen::VectorXd chosen = curves;
  for (int round = 0; round < rounds_; ++round) {
    MoveToA(chosen);
    RemoveMeans(chosen, n_);
  }
  RemoveMeans(chosen, 0);
  return chosen;
}

Eigen::VectorXd ShiftConvention::Transposed(const Eigen::VectorXd& curves) const {
  Eigen::VectorXd functional = curves;
  RemoveMeans(functional, 0);
  for (int round = 0; round < rounds_; ++round) {
    RemoveMeans(functional, n_);
    MoveToATransposed(functional);
  }
  return functional;
}

}  // namespace twinbench::separate::turntable
