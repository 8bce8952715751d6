#pragma once

#include <cstdint>
#include <functional>

#include "tests/scores/row.h"

/// What is scored: sets of cases, each made and judged when its turn comes.
namespace twinbench::scores {

struct Plan {
  std::string set, bench, name;
  std::function<void(Row&)> examine;  // fills in what is hidden, the marks and the answer
};
using Plans = std::vector<Plan>;

struct Amount {
  std::uint64_t first_seed = 1;
  bool is_long = false;  // for the night: some four times as much
};

struct Set {
  std::string name, words;
  Plans (*plans)(const std::string& bench, const Amount& amount);
};
const std::vector<Set>& Sets();

Plans HiddenSet(const std::string& bench, const Amount& amount);
Plans ChallengeSet(const std::string& bench, const Amount& amount);
Plans CleanSet(const std::string& bench, const Amount& amount);
Plans UnlistedSet(const std::string& bench, const Amount& amount);
Plans ForeignSet(const std::string& bench, const Amount& amount);
Plans TwoRunsSet(const std::string& bench, const Amount& amount);
Plans OwnScenarioSet(const std::string& bench, const Amount& amount);
Plans InvestigateSet(const std::string& bench, const Amount& amount);
Plans ShelfSet(const std::string& bench, const Amount& amount);

inline void Append(const Plans& more, Plans& plans) {
  plans.insert(plans.end(), more.begin(), more.end());
}

}  // namespace twinbench::scores
