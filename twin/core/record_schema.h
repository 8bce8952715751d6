#pragma once

#include "twin/core/run_record.h"
#include "twin/core/sqlite_database.h"

/// The tables of record.sqlite. Private to run_record.cc.
namespace twinbench {

void MakeTables(SqliteDatabase& database, const Provenance& provenance);

/// Brings a record of an earlier version up to date.
/// @param folder  Of the record, where its scenario is.
/// @throws InputError unless the file is a whole record of a version that we know.
void CheckRecord(SqliteDatabase& database, const std::string& folder);

}  // namespace twinbench
