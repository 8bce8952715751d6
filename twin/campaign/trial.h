#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "twin/campaign/design.h"

namespace twinbench::campaign {

/// Coverage factor of a two-sided 95 % interval of a normal variable.
inline constexpr double kNormalCoverage = 1.959963984540054;

/// A number that a trial came to, in the unit of its name.
struct TrialResult {
  std::string name;             // its path in results.json, or "score." and its name in the score
  double value, u, error;       // error: against the twin's truth; NaN where that is not known
  double k = kNormalCoverage;   // value +- k u is the stated 95 % interval, by the degrees of freedom behind u
};

/// A row of the table.
struct TrialRow {
  std::int64_t trial = 0;
  std::string failure;               // why it was lost; empty if it was not
  std::string verdict;               // of the diagnosis; empty if none was asked for
  std::vector<TrialResult> results;  // ordered by name
};

/// What the twin of a trial has: every key and seed, what is hidden and the standards as they were drawn.
Scenario TwinOf(const Study& study, const Design& design, std::int64_t trial);

/// Carries one trial out, from scenario to results, without a file. Whatever it throws is the row's failure.
TrialRow RunTrial(const Study& study, const Design& design, std::int64_t trial);

}  // namespace twinbench::campaign
