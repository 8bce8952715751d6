#pragma once

#include <array>
#include <string>
#include <vector>

#include "tests/hidden/judge.h"

/// Outcomes as tables.
namespace twinbench::hidden {

/// P(X <= count) of a binomial distribution.
double ProbabilityOfAtMost(int count, int of, double p);

/// Share of `count` in `of` with its 95 % interval (Clopper-Pearson), both between 0 and 1.
struct Share {
  int count = 0, of = 0;
  double Value() const { return of > 0 ? static_cast<double>(count) / of : kNaN; }
  std::array<double, 2> Interval95() const;
};

/// The score in Markdown: by set, by cause, unlisted causes, false alarms by noise, leave-one-out, calibration of
/// the stated probabilities, parameters, gain, times, and a list of the answers that are not right.
std::string ScoreTable(const std::vector<Outcome>& outcomes);

/// One row a case: set, case, truth, rho, grade, answer, probability, alarm_p, parameters with their truth, gain
/// with its interval, seconds.
std::string CasesCsv(const std::vector<Outcome>& outcomes);

}  // namespace twinbench::hidden
