#pragma once

#include <memory>
#include <optional>

#include "tools/twinbench/run_folder.h"
#include "twin/core/elapsed_time.h"
#include "twin/core/run_record.h"

namespace twinbench::tools {

/// What `twinbench measure` was asked for.
struct MeasureOptions {
  std::string scenario, bench, folder;
  std::vector<std::string> overrides;
  std::vector<std::string> compensations;  // "target=table.csv"
  std::optional<int> web;                  // port of the live page
  bool resume = false, rehearse = false, rehearse_only = false, allow_homing = false;
};

/// The record of a run that was begun before; none: there is nothing to take up.
struct BegunRun {
  std::unique_ptr<RunRecord> record;
  std::vector<Reading> readings;
};

/// @throws InputError if no folder was given.
RunFolder FolderOf(const MeasureOptions& options);

/// Nothing, for a new run, if --resume was not asked for.
/// @throws InputError if the run was another scenario's, if there is none to resume, or files that a new one would overwrite.
BegunRun TakeUpIfAsked(const MeasureOptions& options, const Scenario& scenario, const RunFolder& folder);

/// @param kind  Of the bench file.
std::unique_ptr<RunRecord> BeginRun(const Scenario& scenario, const RunFolder& folder, const std::string& kind,
                                    const std::string& identity);

/// How long ago the run began. The wall clock is all that outlives a power failure; if it was set back meanwhile,
/// the run still goes on behind its last reading. 0 for a new run. What was wrong with a clock is an event of the record.
/// @param now  What this computer's clocks show.
Duration SinceBegin(const BegunRun& begun, const ClockMark& now = ClockMarkNow());

/// Whether its last attempts ended where the zeros of axes may be others, and none was kept behind these.
bool MayHaveLostZeros(const BegunRun& begun);

/// What was kept is not measured again; whatever was tried after it counts as an attempt that failed.
/// @throws BenchError if the run was begun on another bench.
void TakeUp(const BegunRun& begun, const std::string& identity);

}  // namespace twinbench::tools
