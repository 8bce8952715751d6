#include "tools/python/json_values.h"

#include <pybind11/numpy.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

namespace twinbench::python {
namespace {

namespace py = pybind11;
using nlohmann::json;

template <class Number>
py::array_t<Number> ArrayOf(const json& list, Number null) {
  py::array_t<Number> array(static_cast<py::ssize_t>(list.size()));
  auto to = array.template mutable_unchecked<1>();
  py::ssize_t i = 0;
  for (const json& item : list) to(i++) = item.is_null() ? null : item.get<Number>();
  return array;
}

py::object ListOf(const json& list) {
  const auto all = [&](auto&& test) { return !list.empty() && std::ranges::all_of(list, test); };
  if (all([](const json& item) { return item.is_number_integer(); })) return ArrayOf<std::int64_t>(list, 0);
  const bool has_number = std::ranges::any_of(list, [](const json& item) { return item.is_number(); });
  if (has_number && all([](const json& item) { return item.is_number() || item.is_null(); }))
    return ArrayOf<double>(list, std::numeric_limits<double>::quiet_NaN());
  py::list values;
  for (const json& item : list) values.append(ValueOf(item));
  return values;
}

}  // namespace

py::object ValueOf(const json& value) {
  switch (value.type()) {
    case json::value_t::object: {
      py::dict dict;
      for (const auto& [key, item] : value.items()) dict[py::str(key)] = ValueOf(item);
      return dict;
    }
    case json::value_t::array:
      return ListOf(value);
    case json::value_t::string:
      return py::str(value.get_ref<const std::string&>());
    case json::value_t::boolean:
      return py::bool_(value.get<bool>());
    case json::value_t::number_integer:
      return py::int_(value.get<std::int64_t>());
    case json::value_t::number_unsigned:
      return py::int_(value.get<std::uint64_t>());
    case json::value_t::number_float:
      return py::float_(value.get<double>());
    default:
      return py::none();
  }
}

json JsonOf(const py::object& value) {
  const py::object plain = py::module_::import("twinbench.values").attr("plain")(value);
  const py::object text = py::module_::import("json").attr("dumps")(plain);
  return json::parse(text.cast<std::string>());
}

}  // namespace twinbench::python
