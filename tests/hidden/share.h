#pragma once

#include <array>

namespace twinbench::hidden {

/// P(X <= count) of a binomial distribution.
double ProbabilityOfAtMost(int count, int of, double p);

/// `count` cases in `of`.
struct Share {
  int count = 0, of = 0;
  /// Clopper-Pearson, both between 0 and 1; of no cases: all between.
  std::array<double, 2> Interval95() const;
};

}  // namespace twinbench::hidden
