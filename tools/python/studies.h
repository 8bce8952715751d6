#pragma once

#include <pybind11/pybind11.h>

namespace twinbench::python {

/// What is made of many runs: plan, campaign, investigate.
void AddStudies(pybind11::module_& m);

}  // namespace twinbench::python
