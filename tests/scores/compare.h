#pragma once

#include <array>
#include <string>
#include <vector>

#include "tests/scores/row.h"

/// Two scores of the same cases, before and after a change.
namespace twinbench::scores {

/// Of `lost` cases that got worse and `won` that got better: how probable so uneven a split is if the change made
/// no difference. Exact and two-sided (McNemar 1947; the binomial with one half).
double McNemar(int lost, int won);

/// One mark of all cases that both scores asked for it.
struct Changes {
  std::vector<std::string> lost, won;  // "hidden rotary_4dof rotary:tone:all:9: <answer now>"
  double p() const { return McNemar(static_cast<int>(std::ssize(lost)), static_cast<int>(std::ssize(won))); }
  /// More lost than won, and no chance at 5 %.
  bool IsWorse() const { return lost.size() > won.size() && p() <= 0.05; }
};

struct Comparison {
  std::array<Changes, kMarkNames.size()> all;
  std::vector<std::pair<std::string, std::array<Changes, kMarkNames.size()>>> of_bench;  // by name
  int only_now = 0, only_before = 0;                                                     // cases
  bool IsWorse() const;  // any mark of all cases together
};
Comparison Compare(const Rows& now, const Rows& before);

std::string InWords(const Comparison& comparison);

/// Counts by set and bench with 95 % intervals, by what is hidden, and the answers that are not right; Markdown.
std::string Summary(const Rows& rows);

}  // namespace twinbench::scores
