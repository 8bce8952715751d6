#pragma once

#include <cstdint>
#include <vector>

#include "tests/hidden/bench_runs.h"

/// Runs with nothing hidden in them: only the noise may be other than stated.
namespace twinbench::hidden {

enum class Noise { kGaussian, kStudent5, kCorrelated2, kCorrelated3, kUnderstated, kOverstated, kMixture };
inline constexpr int kNoises = 7;

/// `count` runs, the noises in turn. On the angle bench, where the noise is not stated but estimated, that of a
/// wrong size is Gaussian noise of a device whose noise is stated.
std::vector<Plan> CleanPlans(const std::string& bench, int count, std::uint64_t first_seed);

/// One clean run.
Case MakeClean(Design design, Noise noise, std::uint64_t seed);

}  // namespace twinbench::hidden
