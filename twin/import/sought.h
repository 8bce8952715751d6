#pragma once

#include <optional>
#include <string>
#include <vector>

#include "twin/import/map.h"
#include "twin/import/recording.h"

/// Quantities that a map seeks, by the names that people give them.
namespace twinbench::imports {

/// The ready map of whose kind a file is by how its text begins. Nothing: none.
std::optional<Map> ReadyMapByBegin(const std::string& text);

/// The ready map of whose kind a file is: guessed by its columns, with a unit that says what they are where
/// they are few; of several the one that knows
/// most of them. Nothing: none.
std::optional<Map> ReadyMapOf(const Recording& recording);

/// "; if it is ...: --map NAME" of the ready maps that know the columns by their names, which say no units; empty: none.
std::string ReadyMapsByNames(const Recording& recording);

/// Gives every track a column for each quantity that the map seeks, in the unit of its name; drops what the map makes of
/// quantities that are not there; fills in the keys of the scenario.
/// @throws InputError if a quantity is neither found nor made of others, and the bench needs it.
void TakeSought(Map& map, Recording& recording);

}  // namespace twinbench::imports
