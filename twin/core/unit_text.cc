#include "twin/core/unit_text.h"

#include <algorithm>
#include <map>

namespace twinbench {
namespace {

std::string Written(const std::string& name, std::string_view exponents) {
  static const std::map<std::string, std::string> kNames = {{"um", "µm"}, {"urad", "µrad"}, {"us", "µs"}, {"uV", "µV"}, {"degC", "°C"}, {"kohm", "kΩ"}, {"percent", "%"}, {"Nm", "N m"}};
  const bool has_power = name.size() > 1 && (name.back() == '2' || name.back() == '4');
  const std::string base = has_power ? name.substr(0, name.size() - 1) : name;
  const auto found = kNames.find(base);
  const std::string power = has_power ? (name.back() == '2' ? "²" : "⁴") : exponents.empty() ? "" : "¹";
  return (found == kNames.end() ? base : found->second) + (power.empty() ? "" : std::string(exponents) + power);
}

}  // namespace

std::string UnitInPrint(std::string_view unit) {
  static const std::map<std::string_view, std::string> kProducts = {
      {"1", ""}, {"kg_m2", "kg m²"}, {"g_mm", "g mm"}, {"Nm_s_rad", "N m s/rad"}, {"N_s_m", "N s/m"}, {"K_sqrt_h", "K/√h"}};
  if (const auto product = kProducts.find(unit); product != kProducts.end()) return product->second;
  constexpr std::string_view kPer = "per_";
  if (unit.starts_with(kPer)) return Written(std::string(unit.substr(kPer.size())), "⁻");
  std::string text;
  while (!unit.empty()) {
    const std::string name(unit.substr(0, unit.find('_')));
    unit.remove_prefix(std::min(unit.size(), name.size() + 1));
    if (name != "per") text += (text.empty() ? "" : "/") + Written(name, "");
  }
  return text;
}

}  // namespace twinbench
