#pragma once

#include "twin/core/bench_format.h"
#include "twin/import/join.h"

namespace twinbench::imports {

/// A session without the rows that lack a needed value or a time, that the map leaves out by only(a, b), or whose time goes back.
Session WholeRows(const Session& session, const BenchFormat& bench, const Map& map, std::vector<LeftOut>& left_out);

/// These rows of a session.
Session Chosen(const Session& session, const std::vector<std::size_t>& rows);

/// Null if the bench has no such column.
const ReadingColumn* ColumnOf(const BenchFormat& bench, const std::string& name);

}  // namespace twinbench::imports
