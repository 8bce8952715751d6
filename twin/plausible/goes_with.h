#pragma once

#include <vector>

#include "twin/plausible/channel.h"
#include "twin/plausible/check.h"
#include "twin/plausible/expected.h"

namespace twinbench::plausible {

/// Whether a channel goes with what its readings' angles and places say of it: in their order, sense and unit.
void CheckGoesWith(const Channel& channel, const Expected& expected, std::vector<Finding>& findings);

}  // namespace twinbench::plausible
