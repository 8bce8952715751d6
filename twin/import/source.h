#pragma once

#include <string>

#include "twin/import/map.h"
#include "twin/import/recording.h"

namespace twinbench::imports {

/// Reads a file of any of the layouts that this room knows.
/// @throws InputError with the file's name for what cannot be understood, and what to say in the map.
Recording ReadRecording(const std::string& path, const Layout& layout, const ClockSettings& clock);

/// The first rows of a table, or all records of JSON; of another file it has no tracks.
/// @throws InputError if it is no text.
Recording BeginOfTable(const std::string& path, const ClockSettings& clock = {});

/// Says what a text gives away itself: columns with units, clock, rate, gaps; a few lines.
std::string Describe(const Recording& recording);

/// What was left out of the file and what was taken for granted, a line each.
std::string RemarksOn(const Recording& recording);

/// "clock: t [s], 0.1 s between rows (10 Hz)" or "no clock: rows in order".
std::string ClockText(const Track& track);

}  // namespace twinbench::imports
