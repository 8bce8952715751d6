#pragma once

#include <string>
#include <vector>

#include "twin/diagnose/diagnose.h"

/// The scenario that a diagnosis writes, held against readings.
namespace twinbench::hidden {

/// By way of the file's text, as a user has it.
/// @throws InputError if it cannot be read.
Scenario WrittenFile(const Scenario& believed, const diagnose::DiagnosisRun& found);

/// What a diagnosis has to say of the readings; empty if nothing. A refusal is something.
std::string Says(const std::vector<Reading>& readings, const Scenario& scenario,
                 const diagnose::DiagnoseOptions& options);

}  // namespace twinbench::hidden
