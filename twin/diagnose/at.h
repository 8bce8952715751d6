#pragma once

#include <cstddef>

namespace twinbench::diagnose {

/// A row, reading or channel, which Eigen counts in int, as the index of a std::vector.
constexpr std::size_t At(int i) {
  return static_cast<std::size_t>(i);
}

}  // namespace twinbench::diagnose
