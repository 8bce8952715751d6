#pragma once

#include "tests/core/input_error.h"
#include "twin/diagnose/diagnose.h"

namespace twinbench::test {

/// Thresholds are kept here as long as the process lives: a design is calibrated once, as `twinbench diagnose` does it.
inline const std::string& ThresholdsFolder() {
  static const TemporaryFolder folder;
  static const std::string path = folder.path();
  return path;
}

/// Of a diagnosis whose thresholds are those of fewer simulated runs than a user's.
inline diagnose::DiagnoseOptions QuickOptions(int null_runs = 200) {
  diagnose::DiagnoseOptions options;
  options.null_runs = null_runs;
  options.cache_folder = ThresholdsFolder();
  return options;
}

}  // namespace twinbench::test
