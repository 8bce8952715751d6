#pragma once

#include <functional>
#include <vector>

#include "tests/hidden/judge.h"

namespace twinbench::hidden {

struct RunOptions {
  int threads = 2;
  std::string cache_folder;                                                  // of calibrated thresholds
  std::function<void(int done, int planned, const Outcome& last)> progress;  // called by one thread at a time
};

/// Makes, diagnoses and judges every case; the outcomes are in the order of the plans and do not depend on the
/// number of threads, their times apart.
std::vector<Outcome> RunCases(const std::vector<Plan>& plans, const RunOptions& options);

/// One case, in this thread. An InputError is the outcome kRefused.
Outcome RunCase(const Plan& plan, const std::string& cache_folder);

}  // namespace twinbench::hidden
