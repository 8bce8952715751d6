#pragma once

#include <pybind11/pybind11.h>

namespace twinbench::python {

/// `Follow`: the twin on the course of a record.
void AddFollow(pybind11::module_& module);

}  // namespace twinbench::python
