#include "twin/uncertainty/quantities.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace twinbench::uncertainty {
namespace {

using Json = nlohmann::json;

bool IsNumberOrNull(const Json& node) {
  return node.is_number() || node.is_null();
}

double NumberOf(const Json& node) {
  return node.is_number() ? node.get<double>() : std::nan("");
}

std::string Element(const std::string& name, std::size_t i) {
  return name + "[" + std::to_string(i) + "]";
}

/// "value" and "value_um" say only what the path already says, but for the unit.
std::string NameOf(const std::string& path, const std::string& key) {
  constexpr std::string_view kValue = "value";
  if (path.empty()) return key;
  return key.starts_with(kValue) ? path + key.substr(kValue.size()) : path + "." + key;
}

/// The key of the uncertainty of `key`: u, u_um, u_ez_arcsec.
std::string UncertaintyKey(const Json& table, const std::string& key) {
  constexpr std::string_view kValueIn = "value_";
  if (key == "value") return "u";
  const std::string in_unit = key.starts_with(kValueIn) ? "u_" + key.substr(kValueIn.size()) : "";
  return !in_unit.empty() && table.contains(in_unit) ? in_unit : "u_" + key;
}

/// What stands beside or above a number and speaks of its uncertainty.
struct Context {
  double dof = std::numeric_limits<double>::infinity();
  const Json* parts = nullptr;

  /// The parts of one key, where they differ from key to key.
  const Json* PartsOf(const std::string& key) const {
    if (!parts) return nullptr;
    const auto own = parts->find(key);
    return own != parts->end() && own->is_object() ? &*own : parts;
  }
};

/// @param place  In the innermost list.
std::vector<Part> PartsAt(const Json* parts, std::size_t place) {
  std::vector<Part> all;
  if (!parts) return all;
  for (const auto& [name, share] : parts->items()) {
    const bool is_list = share.is_array() && place < share.size();
    const double number = NumberOf(is_list ? share[place] : share);
    if (std::isfinite(number)) all.push_back({name, number});
  }
  return all;
}

class Collector {
 public:
  void Walk(const Json& node, const std::string& path, Context context) {
    if (node.is_array()) {
      for (std::size_t i = 0; i < node.size(); ++i) Walk(node[i], Element(path, i), context);
    }
    if (!node.is_object()) return;
    if (const auto own = node.find("dof"); own != node.end() && own->is_number()) context.dof = own->get<double>();
    if (const auto own = node.find("u_parts"); own != node.end()) context.parts = &*own;
    for (const auto& [key, value] : node.items()) {
      if (key == "diagnosis" || key == "ranked") continue;
      const auto u = node.find(UncertaintyKey(node, key));
      if (u != node.end()) {
        Add(value, *u, NameOf(path, key), {context.dof, context.PartsOf(key)}, 0);
      } else if (!key.starts_with("u_")) {
        Walk(value, path.empty() ? key : path + "." + key, context);
      }
    }
  }

  std::vector<Quantity> found;

 private:
  /// Numbers side by side, however they are packed. What is null was not measured.
  void Add(const Json& value, const Json& u, const std::string& name, const Context& context, std::size_t place) {
    if (IsNumberOrNull(value) && IsNumberOrNull(u)) {
      found.push_back({name, NumberOf(value), NumberOf(u), context.dof, PartsAt(context.parts, place)});
    } else if (value.is_array() && u.is_array() && value.size() == u.size()) {
      for (std::size_t i = 0; i < value.size(); ++i) Add(value[i], u[i], Element(name, i), context, i);
    } else if (value.is_object() && u.is_object()) {
      for (const auto& [key, inner] : value.items()) {
        if (u.contains(key)) Add(inner, u.at(key), name + "." + key, {context.dof, context.PartsOf(key)}, place);
      }
    }
  }
};

}  // namespace

std::vector<Quantity> StatedQuantities(const Json& results) {
  Collector collector;
  collector.Walk(results, "", {});
  return collector.found;
}

std::vector<Quantity> QuantitiesOf(const Json& results) {
  std::vector<Quantity> determined = StatedQuantities(results);
  std::erase_if(determined, [](const Quantity& q) { return !std::isfinite(q.value) || !std::isfinite(q.u); });
  return determined;
}

std::string UnitOf(const std::string& name) {
  static const std::vector<std::string> units = {"arcsec", "mrad", "rad", "deg", "pm", "nm", "um", "mm", "m",
                                                 "mV",     "V",    "px",  "ms",  "s",  "K",  "mK", "ppm"};
  const std::string list = ListOf(name), last = list.substr(list.rfind('_') + 1);
  return list.find('_') != std::string::npos && std::ranges::find(units, last) != units.end() ? last : "";
}

std::string ListOf(const std::string& name) {
  return name.ends_with(']') ? name.substr(0, name.rfind('[')) : name;
}

std::string KindOf(const std::string& name) {
  std::string kind;
  bool in_place = false;
  for (const char c : ListOf(name)) {
    if (c == ']') in_place = false;
    if (!in_place) kind += c;
    if (c == '[') in_place = true;
  }
  return kind;
}

}  // namespace twinbench::uncertainty
