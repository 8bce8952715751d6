#pragma once

#include "twin/plausible/channel.h"
#include "twin/plausible/check.h"
#include "twin/plausible/expected.h"

namespace twinbench::plausible {

/// What contradicts a claim: a channel that does not go with the angles and places of its readings, or goes with another size or
/// sign than it can; scatter and spread that are a small part of what is claimed (each alone is a doubt, both together cannot be);
/// values that are no more alike between neighbours and repeats than between any two readings; values that are there
/// twice in the same order; single values that nothing goes with.
void CheckAgainst(const Expected& expected, const Channel& channel, std::vector<Finding>& findings);

}  // namespace twinbench::plausible
