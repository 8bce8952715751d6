#include "twin/separate/shift_transfer.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "twin/core/errors.h"
#include "twin/core/units.h"

namespace twinbench::separate::shifts {
namespace {

constexpr double kCancelling = 1e-2;  // share of W^2 below which the difference W^2 - |S|^2 is summed over pairs

using Complex = std::complex<double>;

/// exp(2 pi j i / n) of all i, for arguments that are reduced in integers.
class Circle {
 public:
  explicit Circle(int n) : n_(n) {
    for (int i = 0; i < n; ++i) at_.push_back(std::polar(1.0, units::turn * i / n));
  }
  const Complex& At(long long order, int shift) const {
    return at_[static_cast<std::size_t>(((order * shift) % n_ + n_) % n_)];
  }

 private:
  int n_;
  std::vector<Complex> at_;
};

/// W^2 - |S_k|^2 = sum over pairs of w_i w_j |z_i - z_j|^2, where nothing cancels (Lagrange).
double PairSum(const ShiftSet& set, int order) {
  double sum = 0.0;
  for (std::size_t i = 0; i < set.shifts.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const long long steps = static_cast<long long>(order) * (set.shifts[i] - set.shifts[j]) % set.n;
      const double chord = 2.0 * std::sin(units::kPi * static_cast<double>(steps) / set.n);
      sum += set.weights[i] * set.weights[j] * chord * chord;
    }
  }
  return sum;
}

HarmonicTransfer TransferAt(const ShiftSet& set, const Circle& circle, int order) {
  HarmonicTransfer transfer{.order = order};
  for (std::size_t j = 0; j < set.shifts.size(); ++j) {
    transfer.total += set.weights[j];
    transfer.sum += set.weights[j] * circle.At(order, set.shifts[j]);
  }
  const double square = transfer.total * transfer.total;
  transfer.determinant = square - std::norm(transfer.sum);
  if (transfer.determinant < kCancelling * square) transfer.determinant = PairSum(set, order);
  return transfer;
}

void CheckShiftSet(const ShiftSet& set) {
  Require(set.n > 0 && !set.shifts.empty(), "there is at least one mounting of at least one stop");
  Require(set.weights.size() == set.shifts.size(), "one weight a mounting");
  Require(set.rows.empty(), "one row has transfers");
  for (const double w : set.weights) Require(w > 0.0, "weights are positive");
}

}  // namespace

int ShiftSet::Rows() const {
  return rows.empty() ? 1 : *std::ranges::max_element(rows) + 1;
}

ShiftSet ShiftSet::OfRow(int row) const {
  ShiftSet one{n, {}, {}};
  for (std::size_t j = 0; j < shifts.size(); ++j) {
    if (!rows.empty() && rows[j] != row) continue;
    one.shifts.push_back(shifts[j]);
    one.weights.push_back(weights[j]);
  }
  return one;
}

int CommonDivisor(const ShiftSet& set) {
  int common = set.n;
  for (int row = 0; row < set.Rows(); ++row) {
    const ShiftSet one = set.OfRow(row);
    for (const int shift : one.shifts) common = std::gcd(common, shift - one.shifts.front());
  }
  return common;
}

std::vector<int> LostHarmonics(const ShiftSet& set) {
  std::vector<int> lost;
  const int step = set.n / CommonDivisor(set);
  for (int order = step; 2 * order <= set.n; order += step) lost.push_back(order);
  return lost;
}

std::vector<HarmonicTransfer> Transfers(const ShiftSet& set) {
  CheckShiftSet(set);
  const Circle circle(set.n);
  const int step = set.n / CommonDivisor(set);
  std::vector<HarmonicTransfer> transfers;
  for (int k = 0; 2 * k <= set.n; ++k) {
    transfers.push_back(TransferAt(set, circle, k));
    transfers.back().lost = k % step == 0;
  }
  return transfers;
}

}  // namespace twinbench::separate::shifts
