#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>

#include "twin/core/machine.h"
#include "twin/core/scenario.h"

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

}  // namespace twinbench::sim
