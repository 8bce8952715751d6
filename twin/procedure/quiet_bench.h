#pragma once

#include "twin/core/device_call.h"

namespace twinbench::procedure {

/// A bench on which nothing happens: a procedure runs through what was done before without doing it again.
class QuietBench {
 public:
  QuietBench();
  RotaryBench Bench() { return asked_.Bench(); }

 private:
  static CallAnswer Answer(const std::string& device, const std::string& request);

  AskedBench asked_;
};

}  // namespace twinbench::procedure
