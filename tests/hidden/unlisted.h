#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/hidden/bench_runs.h"
#include "tests/hidden/twin_cases.h"

/// Causes that the catalogue lacks, written into the readings of a run that is otherwise clean.
namespace twinbench::hidden {

/// What an unlisted cause adds to each reading and channel [m or rad], up to its size.
struct Unlisted {
  std::string name;
  std::vector<std::string> locks;     // a right signature has one of these words
  std::vector<std::string> channels;  // that it acts on
  Eigen::MatrixXd signal;             // readings x channels
};

/// @param name  One of UnlistedNames(bench).
Unlisted DrawUnlisted(const std::string& name, const std::vector<Reading>& readings, std::uint64_t seed);

std::vector<std::string> UnlistedNames(const std::string& bench);

/// `magnitudes` x `seeds` cases of each.
std::vector<Plan> UnlistedPlans(const std::string& bench, const TwinOptions& options);

}  // namespace twinbench::hidden
