#pragma once

#include <fmt/core.h>

#include <cstdio>

#include "twin/core/device_fault.h"
#include "twin/procedure/attempts.h"

namespace twinbench::tools {

/// Opens a bench; one on which a run has been before is tried again where a fault of its connections or controllers may pass.
/// @param open      Returns the bench. @throws DeviceFault
/// @param attempts  In all; 1: the first fault is the last.
template <class Open>
auto OpenedAgain(int attempts, const Open& open) {
  for (int attempt = 1;; ++attempt) {
    try {
      return open();
    } catch (const DeviceFault& fault) {
      if (attempt >= attempts || !procedure::IsWorthAnotherAttempt(fault.kind())) throw;
      fmt::print(stderr, "twinbench: {} ({}); the bench is opened again\n", fault.what(), FaultName(fault.kind()));
    }
  }
}

}  // namespace twinbench::tools
