#include "twin/benches/diagnosis_json.h"

#include <nlohmann/json.hpp>

#include "twin/benches/registry.h"
#include "twin/diagnose/json.h"

namespace twinbench {

nlohmann::json DiagnosisJson(const diagnose::DiagnosisRun& found, const Scenario& scenario,
                             const std::string& extended_scenario) {
  nlohmann::json json = diagnose::ToJson(found, extended_scenario);
  const auto change_of_tables = BenchOf(scenario).change_of_tables;
  if (change_of_tables && !found.accepted.empty())
    json["gain"]["change_of_tables"] = change_of_tables(found, scenario);
  return json;
}

}  // namespace twinbench
