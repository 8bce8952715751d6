#pragma once

#include <string>
#include <vector>

#include "tests/hidden/known_wrong.h"

/// What tests of the suite's fixed set have in common.
namespace twinbench::hidden {

/// A folder of this program for calibrated thresholds, empty at its start and removed at its end.
const std::string& CacheFolder();

std::vector<Outcome> RunReduced(const std::vector<Plan>& plans, int threads = 1);

int CountOf(const std::vector<Outcome>& outcomes, bool (*test)(const Outcome&));

/// The answers that `right` does not hold for, for messages.
std::string Others(const std::vector<Outcome>& outcomes, bool (*right)(const Outcome&));

}  // namespace twinbench::hidden
