#pragma once

#include "twin/core/scenario.h"
#include "twin/plan/next_run.h"

namespace twinbench::investigate {

/// What the bench of `hidden` does when it is asked for a run of `believed`: the procedure as asked, and every
/// other number moved as the run moves it from `believed`, so that what is wrong with it stays wrong. What happens once
/// has happened in the runs after the scenario's own.
/// @param repeat  Which run it is: the bench is the same one, its noise another.
/// @throws InputError if they are of different benches, or the hidden bench cannot be asked for that.
Scenario HiddenRun(const Scenario& hidden, const Scenario& believed, const plan::NextRun& run, int repeat);

/// Only the procedure differs, or how many scans make a reading: nobody has to change the bench or its room for it.
bool IsProcedureAlone(const plan::NextRun& run);

}  // namespace twinbench::investigate
