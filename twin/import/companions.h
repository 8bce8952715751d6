#pragma once

#include <string>
#include <vector>

#include "twin/import/choices.h"

/// Columns that are one axis by what they hold, whatever they are called.
namespace twinbench::imports {

/// Where an axis should be and where it is.
struct AxisPair {
  const Choice *reference = nullptr, *shown = nullptr;
  std::string why_reference = "by its name", why_shown = "by its name";
  bool has_difference = false;  // a third column is what they differ by
};

/// One to one and closely, row by row.
bool GoTogether(const Column& first, const Column& second);

/// Of each axis two columns that go together to the same places, at once or one later than the other; those first of which a third is
/// the difference, which may be anywhere.
/// Whichever comes later follows; where neither does, the smoother one is followed, else the first. What changes as another pair
/// moves is its rate, and the same column twice is no pair. In the order of the columns, which are of one track.
std::vector<AxisPair> CompanionsIn(const std::vector<const Choice*>& columns);

}  // namespace twinbench::imports
