#pragma once

#include <string>

#include "twin/core/reading.h"
#include "twin/core/sqlite_database.h"

/// A reading as a row of record.sqlite. Private to run_record.cc.
namespace twinbench {

/// Binds the parameters of the insert of a reading, in the order of the columns behind the id.
void BindReading(SqliteStatement& insert, const Reading& reading);

/// @param path  Of the record, for messages.
/// @throws InputError if a name or the JSON in a row is none of ours.
Reading TakeReading(const SqliteStatement& row, const std::string& path);

}  // namespace twinbench
