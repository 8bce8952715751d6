#include "tests/hidden/share.h"

#include <cmath>

namespace twinbench::hidden {
namespace {

/// The p at which ProbabilityOfAtMost falls to `level`.
double SolveAtMost(int count, int of, double level) {
  double low = 0.0, high = 1.0;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (ProbabilityOfAtMost(count, of, middle) > level ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double ProbabilityOfAtMost(int count, int of, double p) {
  if (p <= 0.0) return 1.0;
  if (p >= 1.0) return count >= of ? 1.0 : 0.0;
  double sum = 0.0;  // of no k at all: count may be -1
  for (int k = 0; k <= count; ++k) {
    const double choose = std::lgamma(of + 1.0) - std::lgamma(k + 1.0) - std::lgamma(of - k + 1.0);
    sum += std::exp(choose + k * std::log(p) + (of - k) * std::log1p(-p));
  }
  return sum;
}

std::array<double, 2> Share::Interval95() const {
  if (of == 0) return {0.0, 1.0};
  return {count == 0 ? 0.0 : SolveAtMost(count - 1, of, 0.975), count == of ? 1.0 : SolveAtMost(count, of, 0.025)};
}

}  // namespace twinbench::hidden
