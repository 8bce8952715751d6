#pragma once

#include "twin/core/errors.h"

namespace twinbench {

/// What a recording answers that is told to stop.
class NothingMoves : public BenchError {
 public:
  NothingMoves() : BenchError("a recording is not stopped") {}
};

}  // namespace twinbench
