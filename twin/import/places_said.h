#pragma once

#include <optional>
#include <string>
#include <vector>

#include "twin/import/recording.h"

/// What names and lines of a file say of where something stands: probes round an axis, a circle in a plane.
namespace twinbench::imports {

/// Numbers the columns of probes whose names have their angles ("probe 100 deg", "S_90") as they follow each other round the axis.
/// @return Their angles [deg]; where only a line states them ("sensor angles: 0, 100, 213 deg"), those; empty: nothing does.
std::vector<double> TakeAnglesOfProbes(Track& track);

/// The axes of the plane that a column, or a line ("plane: YZ", "G18"), states; else those in the names of the two columns.
/// @return "YZ"; nothing: none is stated.
/// @throws InputError if circles of several planes are in the file, which have errors of their own each.
std::optional<std::string> PlaneOf(const Track& track, const std::string& first, const std::string& second, const std::string& file);

}  // namespace twinbench::imports
