#pragma once

#include "twin/plausible/channel.h"
#include "twin/plausible/expected.h"
#include "twin/plausible/finding.h"

namespace twinbench::plausible {

/// What a channel, its claimed course, and what that leaves of the channel spread about the mean of each set-up: roots of
/// their sums of squares, of set-ups whose course is no noise [SI].
struct CourseSpread {
  double shown = 0.0, expected = 0.0, left = 0.0;
};
CourseSpread SpreadAbout(const Channel& channel, const Expected& claim);

/// A course made on purpose that is shown by the very channel that should show nothing of it: the two are exchanged. Shown
/// with the other sign by its own, one sign is another than the scenario says; one reading later, the instrument is late.
void CheckCourse(const Expected& claim, const std::vector<Channel>& channels, std::vector<Finding>& findings);

}  // namespace twinbench::plausible
