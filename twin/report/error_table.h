#pragma once

#include <string>
#include <vector>

#include "twin/report/evaluation.h"

/// Results number by number, as a file that a user can write too.
namespace twinbench::report {

/// "errors.csv": a row for each number that has a stated uncertainty, `result,position,position_of,value,u`. A result is named as in
/// separation.json ("target.ez_arcsec[3]"), and what results.json alone has "results.calibration.gain.psd_a_x"; its position is the entry of the list beside its
/// own that says where, as `position_deg` or `order`, and empty where none does.
ResultTable ErrorTable(const Evaluation& evaluation);

/// A user's own numbers against the truth: rms and worst error, and (error / u)^2 where the file has a column `u`, in the table of
/// ScoreTable, above what the program makes of the same readings.
/// @param truth  Of the run's score. Where the truth of a list has no mean, means are taken out of the user's list too.
/// @param file   CSV with columns `result` and `value`.
/// @throws InputError if it has no such columns, a name twice, or no result that has a truth, naming the nearest.
ScoredRun ScoreAgainst(const std::vector<ScoredValue>& truth, const std::string& file);

}  // namespace twinbench::report
