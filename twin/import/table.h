#pragma once

#include "twin/import/layout.h"
#include "twin/import/recording.h"

/// Rows of fields, with names above them or without.
namespace twinbench::imports {

/// What the map says of the time column.
struct ClockSettings {
  std::string column;  // empty: found by its name or its look
  std::string unit;    // s, ms, ..., epoch, filetime; empty: by its name, or by the size of the numbers
  double rate_Hz = 0;  // of rows without a time; 0: not known
};

/// Puts a table's rows into `recording`, one track a part.
/// @throws InputError with file:line if no line is a row of numbers, or a stated header or column is not there.
void ReadTable(std::string_view text, const Layout& layout, const ClockSettings& clock, Recording& recording);

/// Takes the time column out of a track whose columns are read and gives the track its clock.
/// @throws InputError if the stated column is not there or holds no time.
void FindClock(const ClockSettings& settings, const std::string& where, Track& track);

/// Gives rows without a time the rate that a named number states: "sample_rate", "action_hz", "sampling frequency [Hz]".
void TakeStatedRate(Track& track);

/// True of "counts per turn", "ticks/rev", "cpr".
/// @param small  Small letters.
bool SaysPerTurn(const std::string& small);

/// "Pixel scale = 1.54 arc-sec/px, Binning = 1" "Rate: 1000" and "4096 counts/rev": the numbers that have a name.
void AddNumbers(std::string_view line, Track& track);

}  // namespace twinbench::imports
