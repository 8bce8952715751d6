#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <initializer_list>
#include <string>

#include "twin/core/errors.h"

/// Calls of a Python object's methods by a thread that does not hold the interpreter's lock.
namespace twinbench::python {

inline void RequireMethods(const pybind11::object& bench, const std::initializer_list<const char*>& names) {
  for (const char* name : names) {
    if (!pybind11::hasattr(bench, name))
      throw InputError("the bench " + pybind11::str(pybind11::type::of(bench)).cast<std::string>(), std::string("has no method ") + name,
                       "those of twinbench.RotaryBench, twinbench.MachineBench or twinbench.AngleBench");
  }
}

/// What Python raises is a failure of the bench, with Python's own words and place.
template <class Call>
auto Asked(const char* method, Call call) {
  const pybind11::gil_scoped_acquire lock;
  try {
    return call();
  } catch (const pybind11::error_already_set& error) {
    throw BenchError(std::string(method) + "() of the Python bench: " + error.what());
  } catch (const pybind11::cast_error&) {
    throw BenchError(std::string(method) + "() of the Python bench: returned something of another type");
  }
}

template <class Answer = void, class... Arguments>
Answer Ask(const pybind11::object& bench, const char* method, Arguments... arguments) {
  return Asked(method, [&] {
    const pybind11::object answer = bench.attr(method)(arguments...);
    if constexpr (!std::is_void_v<Answer>) return answer.template cast<Answer>();
  });
}

}  // namespace twinbench::python
