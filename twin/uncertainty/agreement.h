#pragma once

#include <vector>

#include "twin/uncertainty/budget.h"
#include "twin/uncertainty/monte_carlo.h"

namespace twinbench::uncertainty {

enum class Verdict { kAgree, kDiffer, kTooFewTrials };
const char* VerdictName(Verdict verdict);  // "agree", "differ", "too_few_trials"

/// Whether the interval of the budget, value +- U, is that of the trials (JCGM 101, 8.1).
struct Agreement {
  double tolerance = 0.0;           // half of one in the last digit of u that is meant
  double d_low = 0.0, d_high = 0.0;  // how far the ends of both symmetric 95 % intervals are apart
  Verdict verdict = Verdict::kTooFewTrials;
};

/// @param digits  Of u that are meant. Trials whose own ends are not known to the tolerance (twice their standard
///                deviation, as for a normal distribution) decide nothing, unless they are further apart than that.
Agreement Compare(const Budget& budget, const Spread& spread, int trials, int digits = 1);

/// Half of one in the last of so many digits of `u` (JCGM 101, 7.9.2).
double NumericalTolerance(double u, int digits);

}  // namespace twinbench::uncertainty
