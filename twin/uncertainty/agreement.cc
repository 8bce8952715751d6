#include "twin/uncertainty/agreement.h"

#include <algorithm>
#include <cmath>

namespace twinbench::uncertainty {
namespace {

/// Standard deviation of the 2.5 % quantile of so many trials of a normal distribution, in its u:
/// sqrt(p (1 - p) / n) over the density there.
double QuantileDeviation(int trials) {
  constexpr double kTail = 0.025, kDensity = 0.0584;
  return std::sqrt(kTail * (1.0 - kTail) / trials) / kDensity;
}

}  // namespace

const char* VerdictName(Verdict verdict) {
  switch (verdict) {
    case Verdict::kAgree:
      return "agree";
    case Verdict::kDiffer:
      return "differ";
    case Verdict::kTooFewTrials:
      return "too_few_trials";
  }
  return "";
}

double NumericalTolerance(double u, int digits) {
  return 0.5 * std::pow(10.0, std::floor(std::log10(u)) - (digits - 1));
}

Agreement Compare(const Budget& budget, const Spread& spread, int trials, int digits) {
  Agreement a;
  a.tolerance = budget.u > 0.0 ? NumericalTolerance(budget.u, digits) : 0.0;
  a.d_low = std::abs(budget.quantity.value - budget.Expanded() - spread.symmetric[0]);
  a.d_high = std::abs(budget.quantity.value + budget.Expanded() - spread.symmetric[1]);
  const double chance = 2.0 * spread.sd * QuantileDeviation(trials), apart = std::max(a.d_low, a.d_high);
  if (apart > a.tolerance + chance)
    a.verdict = Verdict::kDiffer;
  else
    a.verdict = chance > a.tolerance ? Verdict::kTooFewTrials : Verdict::kAgree;
  return a;
}

}  // namespace twinbench::uncertainty
