#pragma once

#include <set>
#include <string>

#include "twin/core/toml_reader.h"

/// What every bench file is asked about where its keys stand.
namespace twinbench::hw {

/// Where the key stands, or else its table, or else the file.
std::string WhereIn(const KeyPlaces& places, const std::string& file, const std::string& key);

/// For a bench that is no hardware.
/// @param kept  Keys that it may have all the same.
/// @throws InputError at the first other one.
void RefuseDevices(const KeyPlaces& places, const std::string& kind, const std::set<std::string>& kept);

/// Of the top of every bench file.
/// @throws InputError for a replay of no record, or a record in a bench of another kind.
void CheckRecord(const KeyPlaces& places, const std::string& file, const std::string& kind, const std::string& record);

/// Makes a path that a file names from its own folder absolute; an empty one stays.
void MakeAbsolute(const std::string& folder, std::string& path);

}  // namespace twinbench::hw
