#pragma once

#include "twin/procedure/machine_options.h"
#include "twin/procedure/standstill.h"
#include "twin/procedure/whereabouts.h"

namespace twinbench::procedure {

/// Brings all axes to rest, as BringToRest.
Standstill StopMachine(MachineBench& bench, const MachineOptions& options);

/// Whether all axes are at rest, as WhetherAtRest.
/// @throws DeviceFault, BenchError where the controller does not answer.
Standstill WhetherMachineStands(MachineBench& bench, const MachineOptions& options);

/// @throws DeviceFault kStopped if the operator said so.
void HearOperator(const MachineOptions& options);

/// Lets bench time pass in slices, so that an operator who says stop is heard.
void WaitFor(MachineBench& bench, Duration duration, const MachineOptions& options);

/// Whatever speaks against a move to a place, before it begins.
/// @param states  One entry an axis, of a look just now.
/// @throws DeviceFault kLimit for a place outside the soft limits or an axis on a limit switch that would be driven
///         further; kRestarted for one that has lost its origin; kRefused for one that reports a fault.
void RequireMayGo(const std::vector<MachineAxis>& axes, const std::vector<AxisState>& states, const std::vector<double>& to,
                  const MachineOptions& options);

/// Whatever speaks against going on with what turns.
/// @return what was looked at, one entry an axis.
/// @throws DeviceFault kLimit for an axis on a limit switch or outside its soft limits, kRestarted, kRefused as above.
std::vector<AxisState> RequireMayTurn(MachineBench& bench, const MachineOptions& options);

/// Returns when the path that was begun has ended with every axis in position.
/// @param takes_s   What the path should take.
/// @param where     To which it was sent.
/// @param look      Called at least every second of bench time on the way.
/// @throws DeviceFault kStalled, kRestarted, kRefused, kLimit (a switch), kNotInPosition (too late, or not there);
///         kMoved (somebody else sent it elsewhere); kStopped.
void Watch(MachineBench& bench, double takes_s, const Whereabouts& where, const MachineOptions& options,
           const std::function<void()>& look = {});

}  // namespace twinbench::procedure
