#pragma once

#include <functional>
#include <string>

#include "tests/hidden/outcome_groups.h"

/// Shares and tables in Markdown.
namespace twinbench::hidden {

/// "97 %"; of no cases "-".
std::string Percent(const Share& share);

/// "29/30 = 96.7 % (82.8 to 99.9)": with its 95 % interval; of no cases "-".
std::string WithInterval(const Share& share);

/// The lines above the rows.
/// @param columns  "set | cases | right".
std::string TableHead(const std::string& columns);

/// One row, or several, of a group.
using Row = std::function<std::string(const std::string& key, const Outcomes& group)>;

std::string Rows(const Groups& groups, const Row& row);

/// A row of each set and `key` ("pairs | t5"), then of each set as a whole ("pairs | all").
std::string RowsBySetAnd(const Key& key, const Outcomes& outcomes, const Row& row);

/// `key` within its set: "pairs | t5".
Key WithinSet(const Key& key);

}  // namespace twinbench::hidden
