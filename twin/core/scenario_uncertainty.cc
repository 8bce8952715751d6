#include "twin/core/scenario_uncertainty.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/core/number_text.h"
#include "twin/core/scenario_values.h"

namespace twinbench {
namespace {

struct Shape {
  const char* name;
  Distribution distribution;
  double half_widths;  // in one standard uncertainty
};

const std::array<Shape, 3>& Shapes() {
  static const std::array<Shape, 3> shapes = {
      {{"normal", Distribution::kNormal, std::numeric_limits<double>::infinity()},
       {"uniform", Distribution::kUniform, std::sqrt(3.0)},
       {"triangular", Distribution::kTriangular, std::sqrt(6.0)}}};
  return shapes;
}

const Shape& ShapeOf(Distribution distribution) {
  return *std::ranges::find(Shapes(), distribution, &Shape::distribution);
}

std::vector<std::string> ShapeNames() {
  std::vector<std::string> names;
  for (const Shape& shape : Shapes()) names.emplace_back(shape.name);
  return names;
}

constexpr const char* kForms =
    "a positive number, { u = ..., dof = ... } or { half_width = ..., distribution = \"uniform\" or \"triangular\" "
    "}";

StatedUncertainty ReadTable(const TomlValue& value, const std::string& path, const ScenarioKey& key) {
  RefuseUnknown(value, path,
                {{path, "u", ""}, {path, "half_width", ""}, {path, "distribution", ""}, {path, "dof", ""}});
  const auto number = [&](const char* name, const Unit& unit, double fallback) {
    const auto inside = Inside(value, name);
    return inside ? ReadNumber(*inside, path + "." + name, unit, {0.0, 1e300, true}) : fallback;
  };
  StatedUncertainty stated;
  stated.u = number("u", key.unit, 0.0);
  stated.dof = number("dof", {}, stated.dof);
  const double half_width = number("half_width", key.unit, 0.0);
  const auto word = Inside(value, "distribution");
  const std::string name = word ? ReadText(*word, path + ".distribution", ShapeNames()) : "normal";
  const Shape& shape = *std::ranges::find(Shapes(), name, &Shape::name);
  stated.distribution = shape.distribution;
  const bool is_bounded = shape.distribution != Distribution::kNormal;
  if ((stated.u > 0.0) == (half_width > 0.0) || (half_width > 0.0 && !is_bounded))
    throw InputError(value.Where(), path + " is " + value.Found(), kForms);
  if (half_width > 0.0) stated.u = half_width / shape.half_widths;
  return stated;
}

StatedUncertainty ReadOne(const TomlValue& value, const ScenarioKey& key) {
  const std::string path = UncertaintyPath(key);
  StatedUncertainty stated;
  if (value.node().is_table()) {
    stated = ReadTable(value, path, key);
  } else if (value.node().is_number()) {
    stated.u = ReadNumber(value, path, key.unit, {0.0, 1e300, true});
  } else {
    throw InputError(value.Where(), path + " is " + value.Found(), kForms);
  }
  stated.key = key.Path();
  return stated;
}

}  // namespace

bool TakesUncertainty(const ScenarioKey& key) {
  return std::holds_alternative<double*>(key.field) || std::holds_alternative<std::span<double>>(key.field) ||
         std::holds_alternative<std::vector<double>*>(key.field);
}

std::string UncertaintyPath(const ScenarioKey& key) {
  return key.table + (key.table.empty() ? "" : ".") + "u_" + key.Name();
}

std::vector<StatedUncertainty> ReadUncertainties(const ScenarioText& text, const std::vector<ScenarioKey>& keys) {
  std::vector<StatedUncertainty> all;
  for (const ScenarioKey& key : keys) {
    if (!TakesUncertainty(key)) continue;
    if (const auto value = text.Find(UncertaintyPath(key))) all.push_back(ReadOne(*value, key));
  }
  return all;
}

std::string PrintUncertainty(const ScenarioKey& key, const std::vector<StatedUncertainty>& stated) {
  const auto found = std::ranges::find(stated, key.Path(), &StatedUncertainty::key);
  if (found == stated.end()) return "";
  const std::string u = PrintInUnit(found->u, key.unit.to_SI);
  std::string more;
  if (found->distribution != Distribution::kNormal)
    more += fmt::format(", distribution = \"{}\"", ShapeOf(found->distribution).name);
  if (std::isfinite(found->dof)) more += ", dof = " + PrintInUnit(found->dof, 1.0);
  return more.empty() ? fmt::format("u_{} = {}\n", key.Name(), u)
                      : fmt::format("u_{} = {{ u = {}{} }}\n", key.Name(), u, more);
}

std::span<double> NumbersAt(Scenario& scenario, const std::string& key) {
  for (ScenarioKey& known : KeysOf(scenario)) {
    if (known.Path() != key) continue;
    if (auto* const* number = std::get_if<double*>(&known.field)) return {*number, 1};
    if (const auto* list = std::get_if<std::span<double>>(&known.field)) return *list;
    if (auto* const* list = std::get_if<std::vector<double>*>(&known.field)) return **list;
  }
  throw std::logic_error("no number of the scenario is called " + key);
}

}  // namespace twinbench
