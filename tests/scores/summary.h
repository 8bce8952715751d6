#pragma once

#include <string>

#include "tests/scores/row.h"

namespace twinbench::scores {

/// Counts by set and bench with 95 % intervals, by what is hidden, and the answers that are not right; Markdown.
std::string Summary(const Rows& rows);

}  // namespace twinbench::scores
