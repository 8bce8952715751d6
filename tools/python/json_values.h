#pragma once

#include <pybind11/pybind11.h>

#include <nlohmann/json_fwd.hpp>

namespace twinbench::python {

/// The same as Python has it: lists of numbers are numpy arrays (float64, null is NaN; int64 where all are whole
/// and written so), other lists are lists, objects are dicts, null is None.
pybind11::object ValueOf(const nlohmann::json& json);

/// A dict of those back again, for truths. @throws pybind11::error_already_set as json.dumps of Python does.
nlohmann::json JsonOf(const pybind11::object& value);

}  // namespace twinbench::python
