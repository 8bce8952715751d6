#pragma once

#include "twin/core/errors.h"

namespace twinbench {

/// Something was told to stand still and nobody knows whether it does. `main` exits with code 3.
class StateUnknown : public BenchError {
 public:
  using BenchError::BenchError;
};

}  // namespace twinbench
