#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "twin/core/machine.h"
#include "twin/core/scenario.h"

namespace twinbench::tools {

/// What a run will ask of a machine, found by carrying it out on the twin first.
struct MachineRehearsal {
  std::vector<AxisLimits> travel;  // lower and upper: where each axis goes
  int readings = 0, without_numbers = 0;
  double duration_s = 0.0;
  std::vector<std::string> problems;
};

/// @param limits   Soft limits of the real machine, one entry an axis; a path beyond them is a problem, not an
///                 exception.
/// @param is_real  Steps that prove the readings of a real bench take their time.
MachineRehearsal RehearseMachine(const Scenario& scenario, const std::vector<AxisLimits>& limits, bool is_real);

/// A table for people, one problem a line at its end.
std::string Summary(const MachineRehearsal& rehearsal, const std::vector<MachineAxis>& axes,
                    const std::vector<AxisLimits>& limits);

/// The same for programs: {"rehearsal": {"readings", "without_numbers", "duration_s", "travel": {axis_unit: [from, to]}, "problems"}}.
nlohmann::json RehearsalJson(const MachineRehearsal& rehearsal, const std::vector<MachineAxis>& axes);

}  // namespace twinbench::tools
