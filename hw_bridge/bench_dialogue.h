#pragma once

#include <string>

#include "hw_bridge/bench_file.h"

namespace twinbench::hw {

/// Whether somebody is reached by a line of his own.
bool HasConnection(const std::string& kind);

/// What a table of a bench file needs of a dialogue.
enum class DialogueRole { kAutocollimator, kThermometer, kGoniometer, kIndexer, kInstrument };

/// Reads the dialogue of a table whose kind is "dialogue"; of "scpi" the one of a served twin, where there is one.
/// @param file, places, folder  Of the bench file.
/// @throws InputError with file:line where none is named, there is no such, or it does not say what the table
/// needs.
void TakeWords(const std::string& file, const KeyPlaces& places, const std::string& folder,
               const std::string& table, DialogueRole role, ControlSettings& settings);

/// Whether two devices can share a connection: one language, one identity.
bool SpeakAlike(const ControlSettings& a, const ControlSettings& b);

}  // namespace twinbench::hw
