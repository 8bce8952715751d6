#pragma once

#include <vector>

#include "twin/core/reading.h"
#include "twin/diagnose/diagnosis.h"
#include "twin/diagnose/engine/linear_run.h"

namespace twinbench::benches::hob {

/// Counts leave a saw-tooth that repeats with each turn, and at a steady speed in time: a periodic error or a tone that is no larger
/// may be nothing else, and is no longer sure.
/// @param run        Of the diagnosis: its noise says how far the saw-tooth is dimmed.
/// @param hob_order  Turns of the hob in one of the table.
void DoubtOrdersOfRounding(const std::vector<Reading>& readings, const diagnose::LinearRun& run, double hob_order,
                           diagnose::Diagnosis& diagnosis);

}  // namespace twinbench::benches::hob
