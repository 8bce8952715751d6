#include "twin/plan/outlook.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace twinbench::plan {
namespace {

std::vector<Certainty> CertaintiesOf(const nlohmann::json& results) {
  std::vector<Certainty> all;
  for (const uncertainty::Quantity& quantity : uncertainty::QuantitiesOf(results)) {
    const std::string name = uncertainty::KindOf(quantity.name);
    auto one = std::ranges::find(all, name, &Certainty::name);
    if (one == all.end()) one = all.insert(all.end(), Certainty{name, 0, 0.0, 0.0});
    ++one->values;
    one->rms_u += quantity.u * quantity.u;
    one->worst_u = std::max(one->worst_u, quantity.u);
  }
  for (Certainty& one : all) one.rms_u = std::sqrt(one.rms_u / static_cast<double>(one.values));
  return all;
}

/// Lists of words, or of what and why.
std::vector<std::string> LostOf(const nlohmann::json& separation) {
  std::vector<std::string> lost;
  if (!separation.is_object() || !separation.contains("not_separable")) return lost;
  for (const auto& one : separation.at("not_separable")) {
    if (one.is_string()) {
      lost.push_back(one.get<std::string>());
    } else if (one.contains("what") && one.contains("why")) {
      lost.push_back(one.at("what").get<std::string>() + ": " + one.at("why").get<std::string>());
    }
  }
  return lost;
}

}  // namespace

Outlook OutlookOf(const nlohmann::json& results, int readings, double last_s) {
  Outlook outlook;
  outlook.readings = readings;
  constexpr double kMinute_s = 60.0;
  outlook.minutes = last_s / kMinute_s;
  outlook.dof = std::nan("");
  outlook.results = CertaintiesOf(results);
  if (!results.contains("separation")) return outlook;
  const nlohmann::json& separation = results.at("separation");
  outlook.not_separable = LostOf(separation);
  if (separation.is_object() && separation.contains("dof") && separation.at("dof").is_number())
    outlook.dof = separation.at("dof").get<double>();
  return outlook;
}

}  // namespace twinbench::plan
