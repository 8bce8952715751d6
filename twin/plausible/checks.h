#pragma once

#include <vector>

#include "twin/core/bench_format.h"
#include "twin/plausible/channel.h"
#include "twin/plausible/check.h"
#include "twin/plausible/expected.h"
#include "twin/plausible/finding.h"

/// What check.h asks of readings, one file each.
namespace twinbench::plausible {

/// What contradicts itself in what readings say of when, where and how they were taken: positions and directions that the angles
/// are against; angles that nothing turns to in the time or that make no circle; clocks that stand; rows that are there twice; and
/// axes whose own encoders stood elsewhere.
void CheckLabels(const std::vector<Reading>& readings, const BenchFormat& bench, std::vector<Finding>& findings);

/// What a channel, its claimed course, and what that leaves of the channel spread about the mean of each set-up: roots of
/// their sums of squares, of set-ups whose course is no noise [SI].
struct CourseSpread {
  double shown = 0.0, expected = 0.0, left = 0.0;
};
CourseSpread SpreadAbout(const Channel& channel, const Expected& claim);

/// A course made on purpose that is shown by the very channel that should show nothing of it: the two are exchanged. Shown
/// with the other sign by its own, one sign is another than the scenario says; one reading later, the instrument is late.
void CheckCourse(const Expected& claim, const std::vector<Channel>& channels, std::vector<Finding>& findings);

/// What contradicts a claim: a channel that does not go with the angles and places of its readings, or goes with another size or
/// sign than it can; scatter and spread that are a small part of what is claimed (each alone is a doubt, both together cannot be);
/// values that are no more alike between neighbours and repeats than between any two readings; values that are there
/// twice in the same order; single values that nothing goes with.
void CheckAgainst(const Expected& expected, const Channel& channel, std::vector<Finding>& findings);

/// One value that is unlike all others of its place, while its neighbours in the pass are like those of theirs.
/// @param left  Of the channel's values beside what they should be.
void CheckRepeatedPlaces(const Expected& expected, const Channel& channel, const std::vector<double>& left,
                         std::vector<Finding>& findings);

/// Of places in passes of both directions: values that are those of the place before, or behind.
void CheckLate(const Expected& expected, const Channel& channel, std::vector<Finding>& findings);

}  // namespace twinbench::plausible
