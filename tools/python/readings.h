#pragma once

#include <string>
#include <vector>

#include "twin/core/reading.h"

namespace twinbench::python {

/// Readings and the name of their bench, which says what their columns are.
struct Readings {
  std::string bench;
  std::vector<Reading> readings;
};

}  // namespace twinbench::python
