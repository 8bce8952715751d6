#pragma once

#include <string>

#include "hw_bridge/bench_file.h"
#include "hw_bridge/machine_file.h"

namespace twinbench::hw {

/// Ties what counts as in position to what the results of a scenario claim: where the file says nothing it is the claim, or what it
/// was if that is less.
/// @param name  Of a table or axis of the file; others are left alone.
/// @param u_rad  Standard uncertainty of a result at one of its stops.
/// @param less   What of the scenario claims less, for the message.
/// @throws InputError with file and line where the file allows more than that.
void TieToClaim(BenchFile& file, const std::string& name, double u_rad, const std::string& less);
/// @param axes  Of the bench, in the order of the file.
/// @param u     Of a linear axis [m].
void TieToClaim(MachineFile& file, const std::vector<MachineAxis>& axes, const std::string& name, double u, const std::string& less);

}  // namespace twinbench::hw
