#include "twin/benches/encoder_comparison/diagnosis/memory.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace twinbench::diagnose::encoder {
namespace {

/// Of what swings: correlations summed up to where they are none. Neighbours of a swing are as alike as those of a walk, which
/// is what one that swings less than a few times may be as well.
std::optional<double> MemoryOfSwing(const Eigen::VectorXd& left) {
  constexpr Eigen::Index kFewestSwings = 5;
  const double power = left.squaredNorm();
  double sum = 1.0;
  for (Eigen::Index lag = 1; kFewestSwings * lag < left.size(); ++lag) {
    const Eigen::Index pairs = left.size() - lag;
    const double correlation = left.head(pairs).dot(left.tail(pairs)) / power;
    if (correlation <= 0.0) return sum;
    sum += 2.0 * correlation;
  }
  return {};
}

}  // namespace

double MemoryOf(const Eigen::VectorXd& left, const std::vector<int>& pass) {
  double products = 0.0, squares = 0.0;
  for (Eigen::Index i = 1; i < left.size(); ++i) {
    if (pass[static_cast<std::size_t>(i)] != pass[static_cast<std::size_t>(i - 1)]) continue;
    products += left[i] * left[i - 1];
    squares += 0.5 * (left[i] * left[i] + left[i - 1] * left[i - 1]);
  }
  constexpr double kMost = 0.999;
  const double rho = squares > 0.0 ? std::clamp(products / squares, 0.0, kMost) : 0.0;
  if (rho < 3.0 / std::sqrt(static_cast<double>(left.size()))) return 1.0;  // by chance
  const double memory = (1.0 + rho) / (1.0 - rho);
  return std::min(memory, MemoryOfSwing(left).value_or(memory));
}

double MemoryAlong(const Eigen::VectorXd& signal, const Eigen::VectorXd& left) {
  constexpr Eigen::Index kStretches = 12;
  const Eigen::Index n = left.size();
  if (n < 4 * kStretches) return 1.0;
  double of_stretches = 0.0;
  for (Eigen::Index k = 0; k < kStretches; ++k) {
    const Eigen::Index first = k * n / kStretches, count = (k + 1) * n / kStretches - first;
    of_stretches += std::pow(signal.segment(first, count).dot(left.segment(first, count)), 2);
  }
  const double as_white = signal.squaredNorm() * left.squaredNorm() / static_cast<double>(n);
  return as_white > 0.0 ? of_stretches / as_white : 1.0;
}

}  // namespace twinbench::diagnose::encoder
