#include "tools/python/parts.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <charconv>
#include <functional>

#include "twin/core/bench_format.h"
#include "twin/core/reading_column.h"

namespace twinbench::python {
namespace {

namespace py = pybind11;

template <class Number>
bool ReadWhole(const std::string& text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

/// All cells as numbers, `empty` where nothing stands; None if one is no such number.
template <class Number>
py::object NumbersOf(const std::vector<std::string>& cells, bool may_be_empty, Number empty) {
  py::array_t<Number> array(static_cast<py::ssize_t>(cells.size()));
  auto to = array.template mutable_unchecked<1>();
  py::ssize_t i = 0;
  for (const std::string& cell : cells) {
    Number number = empty;
    if (!(cell.empty() && may_be_empty) && !ReadWhole(cell, number)) return py::none();
    to(i++) = number;
  }
  return array;
}

py::object ColumnOf(const std::vector<std::string>& cells, bool is_number) {
  if (!is_number) {
    if (py::object whole = NumbersOf<std::int64_t>(cells, false, 0); !whole.is_none()) return whole;
  }
  if (py::object numbers = NumbersOf<double>(cells, true, kNaN); !numbers.is_none()) return numbers;
  return py::cast(cells);
}

std::vector<std::string> CellsOf(const std::vector<Reading>& readings,
                                 const std::function<std::string(const Reading&)>& print) {
  std::vector<std::string> cells;
  cells.reserve(readings.size());
  for (const Reading& reading : readings) cells.push_back(print(reading));
  return cells;
}

void AddColumn(const std::string& name, const std::vector<std::string>& cells, bool is_number, py::dict& columns) {
  const bool is_empty = std::ranges::all_of(cells, &std::string::empty);
  if (!is_empty) columns[py::str(name)] = ColumnOf(cells, is_number);
}

}  // namespace

py::dict ColumnsOf(const std::vector<Reading>& readings, const std::string& bench) {
  py::dict columns;
  for (const ReadingColumn& column : FormatOf(bench).columns)
    AddColumn(column.name, CellsOf(readings, column.print), static_cast<bool>(column.number), columns);
  const auto status = [](const Reading& r) { return std::string(ReadingStatusName(r.status)); };
  columns[kStatusColumn] = py::cast(CellsOf(readings, status));
  if (readings.empty()) return columns;
  for (const auto& [name, text] : readings.front().extra) {
    const auto print = [&name = name](const Reading& r) {
      const auto found = r.extra.find(name);
      return found == r.extra.end() ? std::string() : found->second;
    };
    AddColumn(name, CellsOf(readings, print), false, columns);
  }
  return columns;
}

}  // namespace twinbench::python
