#pragma once

#include <span>
#include <vector>

#include "twin/core/scenario_schema.h"
#include "twin/core/scenario_text.h"

/// The u_<key> of a scenario's keys (stated_uncertainty.h).
namespace twinbench {

/// Whether a key is a number, or a list of them, that may be known less well than it is written.
bool TakesUncertainty(const ScenarioKey& key);

/// "psd_a.u_distance_mm"
std::string UncertaintyPath(const ScenarioKey& key);

/// In the order of `keys`.
/// @throws InputError for what is neither a positive number nor a table that says a distribution.
std::vector<StatedUncertainty> ReadUncertainties(const ScenarioText& text, const std::vector<ScenarioKey>& keys);

/// The line for a file, with its end; empty if nothing is stated of this key.
std::string PrintUncertainty(const ScenarioKey& key, const std::vector<StatedUncertainty>& stated);

/// The numbers that `key` names, to be changed in place.
/// @throws std::logic_error if the scenario's bench has no such number.
std::span<double> NumbersAt(Scenario& scenario, const std::string& key);

}  // namespace twinbench
