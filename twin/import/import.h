#pragma once

#include <optional>
#include <string>
#include <vector>

#include "twin/core/errors.h"
#include "twin/core/reading.h"
#include "twin/import/map.h"
#include "twin/import/recording.h"

/// Anybody's recording as readings of a bench.
namespace twinbench::imports {

struct Imported {
  std::string bench;
  std::vector<Reading> readings;
  std::vector<std::string> set;  // keys of a scenario that say how the axis was driven
  std::vector<std::string> assumed;  // of the sense in which the device counts and of gears
  std::string story;             // what was understood, derived and left out: lines for a person
};

/// What the files give away without a bench, and what would come of them or is still needed: for `import --look`.
struct Seen {
  std::string text;
  std::optional<Imported> imported;
  std::optional<InputError> needs;  // why nothing is imported
};
/// @throws InputError if a file cannot be understood at all.
Seen Look(const std::vector<std::string>& files, const Map& map);

/// Joins the files, unwraps the reference, derives direction, pass, set-up, position and phase where the map does
/// not give them, marks rests and ramps (extra column `motion`), averages what is long.
/// @throws InputError naming file, column or key of the map for whatever cannot be derived, and for a device that
///         does not follow its reference one to one.
Imported Import(const std::vector<std::string>& files, const Map& map);

}  // namespace twinbench::imports
