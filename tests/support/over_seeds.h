#pragma once

#include <cstdint>

/// Statistics over seeds 1 to `count`.
namespace twinbench::test {

/// Mean of what a seed makes, which is a number or an Eigen array (not an expression of one).
template <class Of>
auto MeanOverSeeds(int count, Of of) {
  auto sum = of(std::uint64_t{1});
  for (int seed = 2; seed <= count; ++seed) sum += of(static_cast<std::uint64_t>(seed));
  sum /= count;
  return sum;
}

/// For how many of them it holds.
template <class Holds>
int CountOverSeeds(int count, Holds holds) {
  int held = 0;
  for (int seed = 1; seed <= count; ++seed) held += holds(static_cast<std::uint64_t>(seed)) ? 1 : 0;
  return held;
}

}  // namespace twinbench::test
