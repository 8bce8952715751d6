#pragma once

#include <functional>
#include <vector>

#include "twin/core/device_fault.h"
#include "twin/core/machine.h"
#include "twin/core/run_log.h"
#include "twin/procedure/options.h"

namespace twinbench::procedure {

/// How careful to be with a machine, and where to begin.
struct MachineOptions {
  std::vector<AxisLimits> axes = {};  // one an axis; none: the controller's travel is the only limit
  int attempts = 3;                   // at one reading, before the run stops
  double coldest_degC = -std::numeric_limits<double>::infinity();  // a thermometer beyond these is broken
  double hottest_degC = std::numeric_limits<double>::infinity();
  bool may_home = true;  // whether axes that have lost their origin may be driven to find it
  bool lost_zeros = false;  // a run that is resumed ended where they may be others
  RunLog* log = nullptr;                      // none: only readings are kept, and the first fault ends the run
  std::function<bool()> stop_requested = {};  // asked between moves, waits and readings
  std::function<void(const DeviceFault&)> hear_fault = {};  // before anything is done about it
  std::vector<Reading> kept = {};             // of a resumed run, which goes on behind these
  /// On a real bench: throws where a reading did not go where it should from the one before, in the order of taking. None: not asked.
  std::function<void(const Reading& reading, const Reading& before)> require_goes_along = {};
  /// On a real bench: throws where a reading does not go with those that are kept, of its set-up. None: not asked.
  std::function<void(const Reading& reading, const std::vector<Reading>& kept)> require_no_jump = {};
  /// On a real bench: throws where a reading does not show what it showed before. Behind a fault the last one that was kept at
  /// rest is taken again, and nothing else until it does: a zero or a unit may be another. None: it is not.
  std::function<void(const Reading& again, const Reading& before)> require_as_before = {};
  /// On a real bench, asked about every reading at rest: throws where what is shown does not follow a short step of the axes, which
  /// it makes outside the record and takes back. None: it is not.
  std::function<void(const Reading& reading)> prove = {};
};

}  // namespace twinbench::procedure
