#pragma once

#include <string>
#include <vector>

#include "twin/import/join.h"

namespace twinbench::imports {

/// Leaves out rows whose value lies between the two ends of a wrap: 359.6, 299.3, ..., 60.7, 0.7. A table that was interpolated
/// without regard to the wrap has them; no axis was there, for the other column goes on meanwhile as it does everywhere.
/// @param columns  The two angles that are compared [rad].
/// @param period_rad  After which they start again.
Session WithoutWrapGaps(const Session& session, const std::vector<std::string>& columns, double period_rad,
                        std::vector<LeftOut>& left_out);

}  // namespace twinbench::imports
