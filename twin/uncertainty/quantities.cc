#include "twin/uncertainty/quantities.h"

#include <nlohmann/json.hpp>

namespace twinbench::uncertainty {
namespace {

using Json = nlohmann::json;

class Collector {
 public:
  void Walk(const Json& node, const std::string& path, double dof) {
    if (!node.is_object()) return;
    if (const auto own = node.find("dof"); own != node.end() && own->is_number()) dof = own->get<double>();
    if (IsValueWithU(node)) return Add(node.at("value"), node.at("u"), path, dof);
    for (const auto& [key, value] : node.items()) {
      if (key == "diagnosis" || key.starts_with("u_")) continue;
      const std::string name = path.empty() ? key : path + "." + key;
      const auto u = node.find("u_" + key);
      if (u != node.end()) {
        Add(value, *u, name, dof);
      } else {
        Walk(value, name, dof);
      }
    }
  }

  std::vector<Quantity> found;

 private:
  static bool IsValueWithU(const Json& node) { return node.contains("value") && node.contains("u"); }

  /// Numbers side by side, however they are packed. What is null was not measured.
  void Add(const Json& value, const Json& u, const std::string& name, double dof) {
    if (value.is_number() && u.is_number()) {
      found.push_back({name, value.get<double>(), u.get<double>(), dof});
    } else if (value.is_array() && u.is_array() && value.size() == u.size()) {
      for (std::size_t i = 0; i < value.size(); ++i) Add(value[i], u[i], name + "[" + std::to_string(i) + "]", dof);
    } else if (value.is_object() && u.is_object()) {
      for (const auto& [key, inner] : value.items()) {
        if (u.contains(key)) Add(inner, u.at(key), name + "." + key, dof);
      }
    }
  }
};

}  // namespace

std::vector<Quantity> QuantitiesOf(const Json& results) {
  Collector collector;
  collector.Walk(results, "", std::numeric_limits<double>::infinity());
  return collector.found;
}

std::string ListOf(const std::string& name) {
  return name.ends_with(']') ? name.substr(0, name.rfind('[')) : name;
}

}  // namespace twinbench::uncertainty
