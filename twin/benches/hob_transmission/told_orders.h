#pragma once

#include <vector>

#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/diagnose/diagnosis.h"
#include "twin/diagnose/engine/linear_run.h"

/// What is said of orders that were found.
namespace twinbench::benches::hob {

/// Notes that gears which err as often per turn of the hob as its ring is said to do show the same: two encoders see their
/// difference alone.
void TellGearsBesideRing(diagnose::Diagnosis& diagnosis);

/// Where all readings are of one speed and direction, an error that repeats with the angle of a shaft is a vibration of a
/// frequency: a tone that meets a whole number of periods per turn of the table or of the hob is named together with what
/// errs so, and the verdict is a tie; of one that meets none its orders are a note.
/// @param samples  Of the shafts in motion.
void TellOrdersOfTones(const std::vector<Reading>& samples, const Scenario& scenario, diagnose::Diagnosis& diagnosis);

/// Counts leave a saw-tooth that repeats with each turn, and at a steady speed in time: a periodic error or a tone that is no larger
/// may be nothing else, and is no longer sure.
/// @param run        Of the diagnosis: its noise says how far the saw-tooth is dimmed.
/// @param hob_order  Turns of the hob in one of the table.
void DoubtOrdersOfRounding(const std::vector<Reading>& readings, const diagnose::LinearRun& run, double hob_order,
                           diagnose::Diagnosis& diagnosis);

}  // namespace twinbench::benches::hob
