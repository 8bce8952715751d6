#include "twin/sim/truth.h"

#include <nlohmann/json.hpp>

namespace twinbench::sim {

nlohmann::json ToJson(const TableErrors& errors) {
  nlohmann::json json;
  for (const double angle_rad : errors.position_rad) json["position_deg"].push_back(angle_rad / units::deg);
  for (int c = 0; c < kComponents; ++c) {
    const bool angle = IsAngle(static_cast<Component>(c));
    auto& column = json[std::string(kComponentNames[c]) + (angle ? "_arcsec" : "_um")];
    for (const double value : errors.value[c]) column.push_back(value / (angle ? units::arcsec : units::um));
  }
  return json;
}

nlohmann::json ToJson(const EffectSettings& effect) {
  nlohmann::json json = {{"effect", effect.name}, {"parameters_SI", effect.parameters}};
  if (!effect.where.empty()) json["where"] = effect.where;
  return json;
}

nlohmann::json ToJson(const std::vector<EffectSettings>& effects) {
  nlohmann::json json = nlohmann::json::array();
  for (const EffectSettings& effect : effects) json.push_back(ToJson(effect));
  return json;
}

nlohmann::json ToJson(const Truth& truth) {
  return {{"target", ToJson(truth.target)},
          {"reference", ToJson(truth.reference)},
          {"effects", ToJson(truth.effects)},
          {"seed", truth.seed}};
}

}  // namespace twinbench::sim
