#pragma once

#include "twin/core/scenario.h"
#include "twin/separate/index_errors.h"

namespace twinbench::separate::hob {

/// Transmission error of the table by its angle, wherever both encoders were counted in motion: what the gearbox
/// should be told to take back. The lines of the table's own ring are taken out as far as the places of its head
/// tell them apart; the hob's ring cannot be, and a correction would follow it. Each direction of each set-up has a
/// constant of its own.
/// @throws InputError as MeasurePositions, or if no head position has a complete turn.
IndexErrors HobIndexErrors(const Scenario& scenario, const std::vector<Reading>& readings);

}  // namespace twinbench::separate::hob
