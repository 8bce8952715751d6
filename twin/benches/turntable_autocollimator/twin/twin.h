#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "twin/core/machine.h"
#include "twin/core/scenario.h"
#include "twin/model/follow.h"

namespace twinbench::sim {

/// The virtual bench turntable_autocollimator: devices that a procedure can drive, and the truth that it may not
/// see. The turntable moves as in the rotary bench, the autocollimator traces its beam to the mirror and back.
///
/// Same scenario, same bits: every random number comes from Stream(scenario.seed, name of its cause).
class TurntableTwin : public MachineDevices {
 public:
  /// @throws InputError if a file that the scenario names cannot be read or does not fit, or if the autocollimator
  ///         cannot be built as it says.
  explicit TurntableTwin(const Scenario& scenario);
  ~TurntableTwin() override;

  /// One axis, the turntable. Without an indexer where a polygon stands on it.
  MachineBench Devices() override;

  /// {"turntable": errors at each tooth angle, "multitooth": errors at its teeth, "effects": [...], "seed": n};
  /// with a polygon that is "polygon", and the turntable's errors stand at the angles where its faces are nulled.
  nlohmann::json Truth() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

class ImagesOnce;

/// The turntable bench's twin on the course of a record; predictions are x and y of the autocollimator [rad].
///
/// Free, so zero until given at their points: the errors of both tables and of single teeth. What a mounting
/// scatters enters at "mount" and "axis". The edge of the range is taken a tenth further out, so that no reading
/// that was made there is missing.
/// @param images  Shared with others that follow the same record; may be null.
/// @throws InputError if a file that the scenario names cannot be read or does not fit.
std::unique_ptr<model::Follow> FollowTurntable(const Scenario& scenario, const std::vector<Reading>& record,
                                               const std::shared_ptr<ImagesOnce>& images = nullptr);

}  // namespace twinbench::sim
