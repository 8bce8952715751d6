#pragma once

#include <functional>
#include <vector>

#include "tests/hidden/judge.h"

namespace twinbench::hidden {

/// Does work(0) to work(count - 1), so many at a time.
void InParallel(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

struct RunOptions {
  int threads = 2;
  std::string cache_folder;  // of calibrated thresholds
  int most_null_runs = 500;
};

/// Makes, diagnoses and judges every case; the outcomes are in the order of the plans and do not depend on the
/// number of threads.
std::vector<Outcome> RunCases(const std::vector<Plan>& plans, const RunOptions& options);

/// One case, in this thread. An InputError is the outcome kRefused.
Outcome RunCase(const Plan& plan, const RunOptions& options);

}  // namespace twinbench::hidden
