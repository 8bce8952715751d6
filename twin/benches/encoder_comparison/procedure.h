#pragma once

#include <vector>

#include "twin/benches/encoder_comparison/settings.h"
#include "twin/core/scenario.h"
#include "twin/procedure/options.h"

namespace twinbench::procedure {

/// The readings that a comparison of two angle devices will take: when, at which angle and how fast; `measured_rad`
/// is still empty. Numbers count from 0 in time order.
///
/// Stops: one reading each, evenly spaced, velocity 0; a pass of the other direction goes through the same stops
/// backwards. Several heads: as many readings at one time, each with its head's angle and a set-up number of its
/// own, heads x mounting + head. Sweep: for each speed all passes; constant acceleration, `turns` at constant speed, the same
/// deceleration, a rest (direction 0); each pass begins where the last one ended. Coast: for each speed all passes; one
/// reading a line, reference and measured both its angle on the scale; the bench enters when it passed.
std::vector<Reading> AngleSchedule(const EncoderProcedureSettings& procedure);

/// Carries out the schedule on any bench; every stop goes to `sink` as soon as it is made, readings in motion go in
/// groups of up to 256.
/// @throws BenchError from the devices; what was appended before stays in the sink.
void CarryOut(AngleComparator& bench, const Scenario& scenario, ReadingSink& sink,
              const ProgressCallback& progress = {});

}  // namespace twinbench::procedure
