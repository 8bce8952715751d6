#pragma once

#include <string_view>
#include <vector>

/// The names of the columns of a positioning test: a target, and runs.
namespace twinbench::imports {

/// Of a heading above a table, or of a column: 1 up, -1 down, 0 neither.
int DirectionIn(std::string_view text);

/// "run 2", "Lauf 2", in small letters.
bool NumbersARun(std::string_view name);

/// "no.", "point": it counts rows.
bool CountsRows(std::string_view name);

/// "up; down" without a target: one place, a row a repetition.
bool IsOnePlace(const std::vector<std::string_view>& names);

/// A target, perhaps behind the row's number, and nothing but runs of which each says up or down, and both come.
bool NamesRuns(const std::vector<std::string_view>& names);

/// A target or a reference, and "run 1; run 2; run 3", of which none says where it went.
bool NumbersRuns(const std::vector<std::string_view>& names);

}  // namespace twinbench::imports
