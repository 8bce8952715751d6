#pragma once

#include <vector>

#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/diagnose/diagnosis.h"

namespace twinbench::benches::hob {

/// Where all readings are of one speed and direction, an error that repeats with the angle of a shaft is a vibration of a
/// frequency: a tone that meets a whole number of periods per turn of the table or of the hob is named together with what
/// errs so, and the verdict is a tie; of one that meets none its orders are a note.
/// @param samples  Of the shafts in motion.
void TellOrdersOfTones(const std::vector<Reading>& samples, const Scenario& scenario, diagnose::Diagnosis& diagnosis);

}  // namespace twinbench::benches::hob
