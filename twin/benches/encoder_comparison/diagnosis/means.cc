#include "twin/benches/encoder_comparison/diagnosis/means.h"

#include <algorithm>
#include <cmath>

namespace twinbench::diagnose::encoder {

std::vector<double> Means::Steps() const {
  std::vector<double> steps;
  for (std::size_t k = 1; k < value.size(); ++k) {
    if (IsNext(k)) steps.push_back(value[k] - value[k - 1]);
  }
  return steps;
}

Means MeansOf(const Eigen::VectorXd& rows, const std::vector<int>& setup, Eigen::Index each) {
  Means means;
  for (Eigen::Index i = 0; i + each <= rows.size(); i += each) {
    const int first = setup[static_cast<std::size_t>(i)], last = setup[static_cast<std::size_t>(i + each - 1)];
    if (first != last) continue;
    means.value.push_back(rows.segment(i, each).mean());
    means.setup.push_back(first);
  }
  return means;
}

double EvidenceOfSteps(const std::vector<double>& steps, const std::vector<double>& of_signal) {
  constexpr double kFewest = 8.0, kMostAlike = 0.999999;
  const Eigen::Map<const Eigen::VectorXd> r(steps.data(), std::ssize(steps)), s(of_signal.data(), std::ssize(of_signal));
  const auto count = static_cast<double>(r.size());
  const double both = r.squaredNorm() * s.squaredNorm(), product = r.dot(s);
  if (count < kFewest || !(both > 0.0) || !(product > 0.0)) return 0.0;
  const double alike = std::min(product * product / both, kMostAlike);
  return -0.5 * count * std::log1p(-alike) - 0.5 * std::log(count);
}

}  // namespace twinbench::diagnose::encoder
