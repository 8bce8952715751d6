#pragma once

#include "twin/core/scenario.h"

/// A second run of a machine, on another day.
namespace twinbench::hidden {

/// The same bench asked for another schedule: it begins elsewhere, goes the other way round first, dwells
/// otherwise.
Scenario WithOtherSchedule(Scenario scenario);

/// The same bench with another schedule, other noise, and a room that is warmer and drifts the other way.
Scenario OnAnotherDay(const Scenario& actual);

}  // namespace twinbench::hidden
