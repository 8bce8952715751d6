#pragma once

#include "twin/core/nearest_key.h"
#include "twin/core/scenario_schema.h"
#include "twin/core/scenario_text.h"

namespace twinbench {

/// Takes the number of `value` [unit of the key] to SI.
/// @param key  Its name in messages.
/// @throws InputError if it is no number, not finite or out of bounds.
double ReadNumber(const TomlValue& value, const std::string& key, const Unit& unit, const Bounds& bounds);

/// @throws InputError if it is no text, or none of `choices` where there are any.
std::string ReadText(const TomlValue& value, const std::string& key, const std::vector<std::string>& choices);

/// @return the value of `key` in a table that stands in the text, or nothing.
std::optional<TomlValue> Inside(const TomlValue& table, const std::string& key);

/// Tables, names and units of keys, for messages.
std::vector<KnownKey> KnownKeys(const std::vector<ScenarioKey>& keys);

/// @param path  Of the table, for messages.
/// @throws InputError, naming the nearest of `known`, if the table has another key.
void RefuseUnknown(const TomlValue& table, const std::string& path, const std::vector<KnownKey>& known);

/// Puts `value` where `key` is bound to.
/// @throws InputError if its type, a bound, a choice or the length of a list does not fit.
void ReadKey(const ScenarioKey& key, const TomlValue& value);

/// The same of each key that a table has, which may have no others.
/// @param path  Of the table, for messages.
void ReadKeys(const std::vector<ScenarioKey>& keys, const TomlValue& table, const std::string& path);

/// What a key takes, for messages and help: "a number of nm from 200 to 2000".
std::string Expected(const ScenarioKey& key);

/// The keys inside one entry of `harmonics`, and inside a table of errors or of a compensation.
std::vector<KnownKey> HarmonicKeys();
std::vector<KnownKey> ErrorsKeys(const std::string& table);
std::vector<KnownKey> CompensationKeys(const std::string& table);

/// `"a", "b" or "c"`
std::string Alternatives(const std::vector<std::string>& choices);

}  // namespace twinbench
