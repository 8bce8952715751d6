#pragma once

#include <string>
#include <vector>

#include "twin/diagnose/diagnose.h"

/// The scenario that a diagnosis writes, held against readings; and a second run of a machine, on another day.
namespace twinbench::hidden {

/// By way of the file's text, as a user has it.
/// @throws InputError if it cannot be read.
Scenario WrittenFile(const Scenario& believed, const diagnose::DiagnosisRun& found);

/// What a diagnosis has to say of the readings; empty if nothing. A refusal is something.
std::string Says(const std::vector<Reading>& readings, const Scenario& scenario,
                 const diagnose::DiagnoseOptions& options);

/// The same bench asked for another schedule: it begins elsewhere, goes the other way round first, dwells
/// otherwise.
Scenario WithOtherSchedule(Scenario scenario);

/// The same bench with another schedule, other noise, and a room that is warmer and drifts the other way.
Scenario OnAnotherDay(const Scenario& actual);

}  // namespace twinbench::hidden
