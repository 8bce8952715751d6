#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "twin/core/reading.h"

namespace twinbench::python {

/// The columns of readings.csv by their names, units in the names, the same bits as in the file: float64 with NaN
/// where nothing is there, int64 of counts, lists of text. One that is empty throughout is left out.
pybind11::dict ColumnsOf(const std::vector<Reading>& readings, const std::string& bench);

}  // namespace twinbench::python
