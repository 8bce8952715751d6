#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "twin/benches/rotary_4dof/twin/drives_along.h"
#include "twin/core/devices.h"
#include "twin/core/scenario.h"
#include "twin/model/follow.h"
#include "twin/sim/truth.h"

namespace twinbench::sim {

/// The virtual rotary bench: devices that a procedure can drive, and the truth that it may not see.
///
/// Same scenario, same bits: every random number comes from Stream(scenario.seed, name of its cause).
/// Instances share nothing, so that many may run in as many threads.
class Twin {
 public:
  /// @throws InputError if a file that the scenario names cannot be read or does not fit.
  explicit Twin(const Scenario& scenario);
  ~Twin();

  /// Valid as long as the twin, over restarts too.
  RotaryBench Bench();

  /// What the errors of both tables are at the stops of the scenario's procedure.
  Truth TheTruth() const;

  /// How many events each device has scheduled so far, by its name.
  const std::map<std::string, std::uint64_t>& ScheduledEvents() const;

  /// Rays that Embree has been asked to trace since the last start: what shows that light was traced.
  std::uint64_t RaysTraced() const;

  /// Writes the irradiance on both PSDs at this moment as one multi-part OpenEXR.
  void WriteIrradiance(const std::string& path);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The rotary bench's twin on the course of a record; predictions are the four channels' block means [V].
///
/// Free, so zero until given at their points: the errors of both tables and what every mounting scatters. Where the
/// autocollimator was read, the grating is put to where it saw it, as the scenario's gain says.
/// @param drives  Not null; remembers what was driven, for those who ask with other light.
/// @throws InputError if a file that the scenario names cannot be read or does not fit.
std::unique_ptr<model::Follow> FollowRotary(const Scenario& scenario, const std::vector<Reading>& record,
                                            std::shared_ptr<DrivesOnce> drives);

}  // namespace twinbench::sim
