#pragma once

#include <string>

#include "twin/core/time.h"

namespace twinbench::hw {

/// A device is being waited for as long as this lives; one at a time. Whoever stands at the bench is told from another thread.
class Waiting {
 public:
  /// @param device  Outlives it.
  /// @param beyond  Its answer may take so long.
  Waiting(const std::string& device, Duration beyond);
  ~Waiting();
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;

  /// Whose answer is late by more than half a second; empty: nobody's.
  static std::string Overdue();
};

}  // namespace twinbench::hw
