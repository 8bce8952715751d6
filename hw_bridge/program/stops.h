#pragma once

#include <string>
#include <vector>

#include "twin/core/reading.h"

/// What a program is told to measure, and what it wrote.
namespace twinbench::hw {

/// stops.csv: the planned readings without what the bench will show or measure of the circumstances, columns as in
/// readings.csv.
/// @throws BenchError if the disk refuses.
void WriteStops(const std::vector<Reading>& planned, const std::string& bench, const std::string& path);

struct ReadStops {
  std::vector<Reading> readings;  // in the order of the plan
  int missing = 0;                // stops without a row
  int extra = 0;                  // rows of no stop, and second rows of one
};

/// The program's file: `reading` and what the bench showed, and whatever it measured of the circumstances; what can be planned
/// is as planned, and the rest empty.
/// @throws BenchError if there is no such file, or no row of any stop; InputError with file:line for what is no
///         readings file.
ReadStops ReadStopsBack(const std::string& path, const std::vector<Reading>& planned, const std::string& bench);

}  // namespace twinbench::hw
