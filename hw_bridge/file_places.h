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

}  // namespace twinbench::hw
