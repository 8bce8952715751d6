#pragma once

#include <string>
#include <vector>

#include "twin/core/reading.h"
#include "twin/import/map.h"
#include "twin/import/recording.h"

/// Anybody's recording as readings of a bench.
namespace twinbench::imports {

struct Imported {
  std::string bench;
  std::vector<Reading> readings;
  std::vector<std::string> set;  // keys of a scenario that say how the axis was driven
  std::string story;             // what was understood, derived and left out: lines for a person
};

/// What the files give away without a bench, and what is still needed: for `import --look`.
/// @throws InputError if a file cannot be understood at all.
std::string Look(const std::vector<std::string>& files, const Map& map);

/// Joins the files, unwraps the reference, derives direction, pass, set-up, position and phase where the map does
/// not give them, marks rests and ramps (extra column `motion`), averages what is long.
/// @throws InputError naming file, column or key of the map for whatever cannot be derived, and for a device that
///         does not follow its reference one to one.
Imported Import(const std::vector<std::string>& files, const Map& map);

}  // namespace twinbench::imports
