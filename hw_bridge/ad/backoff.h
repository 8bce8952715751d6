#pragma once

#include "twin/core/time.h"

namespace twinbench::hw {

/// How long to leave a device alone that does not open: nothing at first, then 50 ms doubled at every failure, up
/// to 1.6 s.
class Backoff {
 public:
  /// Sleeps as long as the failures so far ask for, and counts the attempt that follows as a failure.
  void BeforeAttempt();
  void Succeeded() { failures_ = 0; }

 private:
  int failures_ = 0;
};

}  // namespace twinbench::hw
