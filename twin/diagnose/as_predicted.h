#pragma once

#include <vector>

#include "twin/diagnose/compared.h"

namespace twinbench::diagnose {

/// Columns that a bench must show.
std::vector<ReadingColumn> ShownColumns(const TwinComparison& comparison);

/// The used readings as the twin says them.
std::vector<Reading> AsPredicted(const Compared& compared, const TwinComparison& comparison);

/// The same in the record; it itself if the comparison does not tell how.
std::vector<Reading> RecordAsPredicted(const Compared& compared, std::vector<Reading> readings,
                                       const TwinComparison& comparison);

}  // namespace twinbench::diagnose
