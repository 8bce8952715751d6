#pragma once

#include <pybind11/pybind11.h>

namespace twinbench::python {

/// Ctrl-C ends what takes long: asked now and then by a thread without the interpreter's lock.
inline void HearInterrupt() {
  const pybind11::gil_scoped_acquire lock;
  if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
}

}  // namespace twinbench::python
