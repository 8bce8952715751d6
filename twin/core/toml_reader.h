#pragma once

#include <map>
#include <string>
#include <vector>

#include "twin/core/scenario_schema.h"

namespace twinbench {

/// Where keys stand: "file.toml:12" by path ("target.axis"), of those that were set; of tables, too.
using KeyPlaces = std::map<std::string, std::string>;

/// Reads a TOML text whose every key is described by `keys`, in tables of at most one level, and puts each value
/// where its key is bound to. It need not be a scenario.
/// @param name  Of the file, for messages.
/// @throws InputError with file:line for a syntax error, an unknown key or table (naming the nearest), a value that
/// is
///         out of bounds, of the wrong type or none of the choices.
KeyPlaces ReadToml(const std::string& text, const std::string& name, const std::vector<ScenarioKey>& keys);

/// The text of one key at the top, whatever else there is; empty if there is none.
/// @throws InputError with file:line for a syntax error.
std::string TextAtTop(const std::string& text, const std::string& name, const std::string& key);

/// Whether there is such a table.
/// @throws InputError as above.
bool HasTable(const std::string& text, const std::string& name, const std::string& table);

}  // namespace twinbench
