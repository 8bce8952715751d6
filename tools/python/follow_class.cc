#include "tools/python/parts.h"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <map>
#include <memory>
#include <tuple>

#include "twin/benches/registry.h"
#include "twin/core/errors.h"
#include "twin/core/nearest_key.h"
#include "twin/model/follow.h"

namespace twinbench::python {
namespace {

namespace py = pybind11;
using model::Disturbance, model::Follow, model::Point;
using AtPoints = std::map<std::string, Eigen::VectorXd>;

const Point& Named(const Follow& follow, const std::string& name) {
  std::vector<std::string> names;
  for (const Point& point : follow.Points()) {
    if (point.name == name) return point;
    names.push_back(point.name);
  }
  throw InputError("Follow", "\"" + name + "\" is no point of this bench",
                   "one of points; the nearest is \"" + Nearest(name, names) + "\"");
}

std::vector<Disturbance> DisturbancesOf(const Follow& follow, const AtPoints& at) {
  std::vector<Disturbance> all;
  for (const auto& [name, value] : at) {
    Named(follow, name);
    if (value.size() != follow.Readings())
      throw InputError("Follow", name + " has " + std::to_string(value.size()) + " values",
                       std::to_string(follow.Readings()) + ", one a reading [SI]");
    all.push_back({name, value});
  }
  return all;
}

std::vector<std::tuple<std::string, std::string, double>> PointsOf(const Follow& follow) {
  std::vector<std::tuple<std::string, std::string, double>> points;
  for (const Point& point : follow.Points()) points.emplace_back(point.name, point.unit, point.to_SI);
  return points;
}

}  // namespace

void AddFollow(py::module_& module) {
  using NoLock = py::call_guard<py::gil_scoped_release>;
  py::class_<Follow>(module, "Follow")
      .def("points", &PointsOf, "(name, unit of reports, its factor to SI) of each point")
      .def("__len__", &Follow::Readings)
      .def("unfixed", &Follow::Unfixed)
      .def(
          "predict",
          [](const Follow& follow, const AtPoints& at) { return follow.Predict(DisturbancesOf(follow, at)); },
          NoLock(), py::arg("disturbances") = AtPoints())
      .def(
          "slope",
          [](const Follow& follow, const std::string& point, const AtPoints& at) {
            return model::Slope(follow, Named(follow, point), DisturbancesOf(follow, at));
          },
          NoLock(), py::arg("point"), py::arg("disturbances") = AtPoints());
}

}  // namespace twinbench::python
