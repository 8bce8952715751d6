#pragma once

#include <string>
#include <vector>

#include "twin/core/reading_column.h"

/// Single readings of probes that a turn would take for a motion of the axis.
namespace twinbench::separate::rotary {

struct FarReading {
  int reading = 0;  // its number
  std::string column;
  double target_rad = 0.0;
  double off = 0.0;    // from the curve through its neighbours, SI
  double times = 0.0;  // the scatter of the others
};

/// Puts the curve through the neighbours in the place of single readings that lie far from it, in one turn and in no
/// other. Of a setup that has one turn none: an artefact may have a scratch there.
/// @return what was replaced, the farthest of each column first; none where they are so many that the axis moves so.
std::vector<FarReading> ReplaceFar(const std::vector<Quantity>& columns, std::vector<Reading>& readings);

}  // namespace twinbench::separate::rotary
