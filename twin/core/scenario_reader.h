#pragma once

#include <string>
#include <vector>

#include "twin/core/scenario.h"
#include "twin/core/scenario_schema.h"
#include "twin/core/scenario_text.h"
#include "twin/core/toml_reader.h"

/// The parts of a scenario's text, each read and checked by itself; what does not fit is an InputError with its place.
namespace twinbench {

inline constexpr const char* kEffectTable = "effect";
inline constexpr const char* kFixtureTable = "fixture";
inline constexpr const char* kEmpiricalTable = "empirical";

/// Refuses what is not in the description, in one source of the text.
void RefuseUnknownKeys(const TomlSource& source, const std::vector<ScenarioKey>& keys, const std::string& bench);

FixtureSettings ReadFixture(const TomlValue& block);
EffectSettings ReadEffect(const TomlValue& block, const std::string& bench);
EmpiricalSettings ReadEmpirical(const TomlValue& block, const std::string& bench);

/// The files that keys name: paths become absolute, and tables in them the scenario's.
/// @param folder  Paths are from there.
void LoadFiles(const ScenarioText& text, const std::string& folder, const std::vector<ScenarioKey>& keys);
void LoadMeshes(const std::string& folder, std::vector<FixtureSettings>& fixtures);

}  // namespace twinbench
