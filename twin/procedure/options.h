#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "twin/core/device_fault.h"
#include "twin/core/devices.h"
#include "twin/core/run_log.h"
#include "twin/core/table_limits.h"

namespace twinbench::procedure {

/// How far a run has come; `bench_time` is on the bench's own clock.
struct Progress {
  int readings_done = 0;
  int readings_planned = 0;
  Phase phase = Phase::kFullCircle;
  Time bench_time{};
};
using ProgressCallback = std::function<void(const Progress&)>;

/// In the event of a mounting that a person said was done.
inline constexpr const char* kMountedByHand = " by hand";

/// How careful to be, and where to begin.
struct Options {
  TableLimits target, reference;
  int attempts = 3;  // at one reading, before the run stops
  double jump_V =
      std::numeric_limits<double>::infinity();  // between neighbouring stops of a pass; more: implausible
  double coldest_degC = -std::numeric_limits<double>::infinity();  // a thermometer beyond these is broken
  double hottest_degC = std::numeric_limits<double>::infinity();
  bool may_home = true;  // whether a table that has lost its origin may be driven to find it
  bool lost_zeros = false;  // a run that is resumed ended where they may be others
  bool hand_ends_mounting = false;  // a person says when a mounting is done; else the scenario's remount_s passes
  bool looks_at_encoders = true;  // about every block; false: of a recording that knows no such looks
  RunLog* log = nullptr;                 // none: only readings are kept, and the first fault ends the run
  std::function<bool()> stop_requested;  // asked between moves, waits and readings
  std::function<void(const DeviceFault&)> hear_fault = {};  // before anything is done about it
  std::function<void(const Reading&)> prove = {};  // as MachineOptions::prove; in a stability test before its first and about its last

  std::vector<Reading> kept = {};           // of a resumed run, which goes on behind these ...
  std::vector<DeviceCall> calls_done = {};  // ... on a simulated bench by doing these again
};

}  // namespace twinbench::procedure
