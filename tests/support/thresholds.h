#pragma once

#include <string>

#include "tests/core/input_error.h"

namespace twinbench::test {

/// Thresholds are kept here as long as the process lives: a design is calibrated once, as `twinbench diagnose` does it.
inline const std::string& ThresholdsFolder() {
  static const TemporaryFolder folder;
  static const std::string path = folder.path();
  return path;
}

}  // namespace twinbench::test
