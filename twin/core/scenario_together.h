#pragma once

#include <string>
#include <vector>

/// What a bench needs to say where the keys of a scenario do not fit each other (BenchFormat::check_together).
namespace twinbench {

class ScenarioText;

/// File and line where `key` stands; else of `other`, else the first line.
std::string Place(const ScenarioText& text, const std::string& key);
std::string Place(const ScenarioText& text, const std::string& key, const std::string& other);

/// @throws InputError if a direction is 0.
void CheckPasses(const ScenarioText& text, const std::string& key, const std::vector<int>& passes);

}  // namespace twinbench
