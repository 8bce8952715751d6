#pragma once

#include <cstdlib>

namespace twinbench::test {

/// .ci/nightly sets it: what takes long for every change has many seeds then, and in tools/test few that still see gross faults.
inline bool IsNight() { return std::getenv("TWINBENCH_NIGHT") != nullptr; }

/// How many of something random a test tries. Its tolerance must follow from the number.
inline int ByNight(int many, int few) { return IsNight() ? many : few; }

}  // namespace twinbench::test
