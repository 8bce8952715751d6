#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "twin/core/scenario.h"
#include "twin/diagnose/diagnose.h"

namespace twinbench {

/// diagnosis.json of the scenario's bench: diagnose::ToJson, with what the accepted causes change in the separated
/// errors.
/// @param extended_scenario  Path of the file that was written; empty: none, null in the file.
nlohmann::json DiagnosisJson(const diagnose::DiagnosisRun& found, const Scenario& scenario,
                             const std::string& extended_scenario);

}  // namespace twinbench
