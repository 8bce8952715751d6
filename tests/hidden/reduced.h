#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/hidden/run_cases.h"

/// What the reduced set has in common.
namespace twinbench::hidden {

/// A folder of this program for calibrated thresholds, empty at its start and removed at its end.
const std::string& CacheFolder();

/// One thread: ctest runs programs side by side.
std::vector<Outcome> RunReduced(const std::vector<Plan>& plans);

int CountOf(const std::vector<Outcome>& outcomes, bool (*test)(const Outcome&));

/// Fails if so few of so many would happen in less than 1 % of trials whose true rate is `rate`.
::testing::AssertionResult IsNotBelow(int count, std::size_t of, double rate);
/// Fails if so many of so many would happen in less than 1 % of trials whose true rate is `rate`.
::testing::AssertionResult IsNotAbove(int count, std::size_t of, double rate);

/// The answers that `right` does not hold for, for messages.
std::string Others(const std::vector<Outcome>& outcomes, bool (*right)(const Outcome&));

}  // namespace twinbench::hidden
