#pragma once

#include <vector>

#include "twin/benches/encoder_comparison/settings.h"
#include "twin/core/scenario.h"
#include "twin/procedure/machine_sequencer.h"
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

/// @throws InputError for a spindle that coasts: nothing that can be asked of a machine lets go of its drive.
void RequireDriven(const Scenario& scenario);

/// Carries a comparison out on any such bench: one rotary axis (the shaft), instruments that show at one instant what the
/// reference and the device say.
///
/// Stops: a pass comes to its first stop from behind, over half the way from stop to stop; every stop is read when it is
/// due, never sooner than half an interval behind the move. Sweeps: the shaft goes over to its speed and back to rest, and
/// the instruments are read at every interval meanwhile. On a real bench the times of a pass count from where it began, and
/// its readings have no velocity: the reference's angles and times tell it. A resumed pass is gone again from its beginning.
/// @throws what CarryOutPlan throws; InputError as RequireDriven; DeviceFault kRefused for a bench with other axes, and for
///         several heads on a real bench, whose instruments show one.
void DriveComparison(MachineBench& bench, const Scenario& scenario, ReadingSink& sink,
                     const ProgressCallback& progress, const MachineOptions& options);

}  // namespace twinbench::procedure
