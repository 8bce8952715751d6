#pragma once

#include <pybind11/pybind11.h>
#include <string>
#include <vector>

#include "twin/core/reading.h"

/// The parts of the Python module, one file each.
namespace twinbench::python {

/// What commands make of one run: results, uncertainty, compensation, certificate, page, folder; and of recordings.
void AddAnswers(pybind11::module_& m);

/// `Follow`: the twin on the course of a record.
void AddFollow(pybind11::module_& module);

/// The columns of readings.csv by their names, units in the names, the same bits as in the file: float64 with NaN
/// where nothing is there, int64 of counts, lists of text. One that is empty throughout is left out.
pybind11::dict ColumnsOf(const std::vector<Reading>& readings, const std::string& bench);

/// What is made of many runs: plan, campaign, investigate.
void AddStudies(pybind11::module_& m);

}  // namespace twinbench::python
