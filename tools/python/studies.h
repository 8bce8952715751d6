#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "twin/core/reading.h"

namespace twinbench::python {

/// Readings and the name of their bench, which says what their columns are.
struct Readings {
  std::string bench;
  std::vector<Reading> readings;
};

/// What is made of many runs: plan, campaign, investigate.
void AddStudies(pybind11::module_& m);

}  // namespace twinbench::python
