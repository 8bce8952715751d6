#pragma once

#include <pybind11/pybind11.h>

namespace twinbench::python {

/// What commands make of one run: results, uncertainty, compensation, certificate, page, folder; and of recordings.
void AddAnswers(pybind11::module_& m);

}  // namespace twinbench::python
