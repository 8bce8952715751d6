#pragma once

#include <string>
#include <vector>

#include "twin/core/bench_format.h"
#include "twin/import/join.h"
#include "twin/import/map.h"

namespace twinbench::imports {

/// What both columns have to be multiplied by to be one angle in one sense.
struct Alignment {
  double reference = 1.0, shown = 1.0;
  std::string said;  // what was assumed; empty: nothing had to be

  bool IsNeeded() const { return !said.empty(); }
};

/// A device that follows on a line, but counts against its reference, or a whole number of times as far: a motor in
/// front of a gear. A ratio that is that of two units is no gear.
Alignment AlignmentOf(const Session& session, const std::vector<double>& reference, const BenchFormat& bench,
                      const Map& map);

struct HowItFollows {
  std::string said;  // what a reader has to know of it: later, or not as far; or nothing
  bool is_later = false;
};

/// Refuses a device that does not follow its reference, at once or later, or that is in another unit or sense, with the likely
/// reason and the line to write.
/// @param reference  Without breaks [rad], an entry a row of the session.
/// @param one_place  The reference stands still and is reached from both sides: nothing has to follow.
/// @throws InputError
HowItFollows RequireOneToOne(const Session& session, const std::vector<double>& reference, bool one_place, const BenchFormat& bench,
                            const Map& map);

}  // namespace twinbench::imports
