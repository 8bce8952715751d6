#pragma once

#include <string>
#include <vector>

#include "twin/core/bench_format.h"
#include "twin/import/join.h"
#include "twin/import/map.h"

namespace twinbench::imports {

/// Refuses a device that does not follow its reference, at once or later, or that is in another unit or sense, with the likely
/// reason and the line to write.
/// @param reference  Without breaks [rad], an entry a row of the session.
/// @param one_place  The reference stands still and is reached from both sides: nothing has to follow.
/// @return what a reader has to know of how it follows (later, or not as far), or nothing.
/// @throws InputError
std::string RequireOneToOne(const Session& session, const std::vector<double>& reference, bool one_place, const BenchFormat& bench,
                            const Map& map);

}  // namespace twinbench::imports
