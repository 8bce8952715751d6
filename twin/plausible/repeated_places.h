#pragma once

#include <vector>

#include "twin/plausible/channel.h"
#include "twin/plausible/expected.h"
#include "twin/plausible/finding.h"

namespace twinbench::plausible {

/// One value that is unlike all others of its place, while its neighbours in the pass are like those of theirs.
/// @param left  Of the channel's values beside what they should be.
void CheckRepeatedPlaces(const Expected& expected, const Channel& channel, const std::vector<double>& left,
                         std::vector<Finding>& findings);

}  // namespace twinbench::plausible
