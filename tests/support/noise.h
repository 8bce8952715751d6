#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "tests/support/night.h"

namespace twinbench::test {

/// White noise of this deviation.
class Noise {
 public:
  Noise(double deviation, std::uint64_t seed) : random_(seed), normal_(0.0, deviation) {}
  double operator()() { return normal_(random_); }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

/// By night all of them, else the first.
inline std::vector<unsigned> Seeds(std::vector<unsigned> all) {
  if (!IsNight()) all.resize(1);
  return all;
}

}  // namespace twinbench::test
