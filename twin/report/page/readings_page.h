#pragma once

#include <string>
#include <vector>

#include "twin/core/reading.h"
#include "twin/report/page/figure.h"

namespace twinbench::report {

/// What was read, every column against every other, and the tracks of spots: columns that go together as x and y of one place.
/// @param bench  Its name; it decides the columns. Nothing is shown of a bench that this program does not know.
PageSection ReadingsSection(const std::vector<Reading>& readings, const std::string& bench);

}  // namespace twinbench::report
